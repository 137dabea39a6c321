/* gltf.h - a glTF 2.0 document in the making: numbers go into its buffer, what says what they are into its JSON.
 * Source: Khronos Group, glTF 2.0 Specification, ISO/IEC 12113:2022. */
#pragma once
#include "base/error.h"
#include "export/bytes.h"
#include "io/colormap.h"
#include "io/text.h"

/* Bodies of the JSON's lists, and how many each has. */
typedef struct GltfList {
    Text text;
    int count;
} GltfList;

typedef struct Gltf {
    Bytes buffer;
    GltfList views, accessors, materials, meshes, nodes, samplers, channels;
} Gltf;

/* Begins the next entry of a list, whose number it returns; the caller adds its JSON to the text. */
int gltf_next(GltfList *list);

/* Accessors of `count` rows of `width` numbers (1 to 4), with their bounds; of vertices, or other numbers (times, ..). */
int gltf_vertices(Gltf *gltf, const float *numbers, int count, int width);
int gltf_numbers(Gltf *gltf, const float *numbers, int count, int width);
int gltf_indices(Gltf *gltf, const int *indices, int count);

/* A dull material. */
int gltf_material(Gltf *gltf, const char *name, Color color, bool two_sided);

/* A node's property ("translation", "rotation", "scale" or "weights") over time, width numbers at each; or in steps. */
void gltf_animate(Gltf *gltf, int node, const char *property, int times, const float *values, int count,
                  int width, bool steps);

/* The file, of what was added; node 0 is the scene's root. False where it would be too large. */
bool gltf_write(const Gltf *gltf, Bytes *file, Error *err);
void gltf_clear(Gltf *gltf);
