#include "export/gltf.h"
#include "base/memory.h"
#include "io/mark.h"
#include <math.h>
#include <string.h>

enum {
    TYPE_FLOAT = 5126,
    TYPE_UINT = 5125,
    TARGET_NONE = 0,
    TARGET_VERTICES = 34962,
    TARGET_INDICES = 34963
};

static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};

int gltf_next(GltfList *list)
{
    if (list->count) text_add(&list->text, ",\n");
    return list->count++;
}

/* The numbers themselves, 4 bytes each. */
static int add_view(Gltf *gltf, const void *numbers, size_t count, int target)
{
    int view = gltf_next(&gltf->views);
    text_add(&gltf->views.text, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu", gltf->buffer.size,
             4 * count);
    if (target) text_add(&gltf->views.text, ",\"target\":%d", target);
    text_add(&gltf->views.text, "}");
    bytes_add(&gltf->buffer, numbers, 4 * count);
    return view;
}

static void add_bound(Text *text, const char *name, const float *numbers, int count, int width, bool most)
{
    text_add(text, ",\"%s\":[", name);
    for (int i = 0; i < width; i++) {
        float bound = numbers[i];
        for (int k = 1; k < count; k++) {
            float number = numbers[k * width + i];
            if (most ? number > bound : number < bound) bound = number;
        }
        text_add(text, "%s%.9g", i ? "," : "", (double)bound);
    }
    text_add(text, "]");
}

static int add_floats(Gltf *gltf, const float *numbers, int count, int width, int target)
{
    int view = add_view(gltf, numbers, (size_t)count * (size_t)width, target);
    int accessor = gltf_next(&gltf->accessors);
    Text *text = &gltf->accessors.text;
    text_add(text, "{\"bufferView\":%d,\"componentType\":%d,\"count\":%d,\"type\":\"%s\"", view, TYPE_FLOAT,
             count, types[width]);
    add_bound(text, "min", numbers, count, width, false);
    add_bound(text, "max", numbers, count, width, true);
    text_add(text, "}");
    return accessor;
}

int gltf_vertices(Gltf *gltf, const float *numbers, int count, int width)
{
    return add_floats(gltf, numbers, count, width, TARGET_VERTICES);
}

int gltf_numbers(Gltf *gltf, const float *numbers, int count, int width)
{
    return add_floats(gltf, numbers, count, width, TARGET_NONE);
}

int gltf_indices(Gltf *gltf, const int *indices, int count)
{
    int view = add_view(gltf, indices, (size_t)count, TARGET_INDICES);
    int accessor = gltf_next(&gltf->accessors);
    text_add(&gltf->accessors.text,
             "{\"bufferView\":%d,\"componentType\":%d,\"count\":%d,\"type\":\"SCALAR\"}", view, TYPE_UINT,
             count);
    return accessor;
}

int gltf_material(Gltf *gltf, const char *name, Color color, bool two_sided)
{
    int material = gltf_next(&gltf->materials);
    Text *text = &gltf->materials.text;
    text_add(text, "{\"name\":");
    text_add_quoted(text, name);
    text_add(text,
             ",\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.6g,%.6g,%.6g,1],\"metallicFactor\":0,"
             "\"roughnessFactor\":0.8},\"doubleSided\":%s}",
             color_linear(color.r), color_linear(color.g), color_linear(color.b),
             two_sided ? "true" : "false");
    return material;
}

void gltf_animate(Gltf *gltf, int node, const char *property, int times, const float *values, int count,
                  int width, bool steps)
{
    bool weights = !strcmp(property, "weights"); /* one number each, as glTF has them */
    int output =
        weights ? gltf_numbers(gltf, values, count * width, 1) : gltf_numbers(gltf, values, count, width);
    int sampler = gltf_next(&gltf->samplers);
    text_add(&gltf->samplers.text, "{\"input\":%d,\"output\":%d,\"interpolation\":\"%s\"}", times, output,
             steps ? "STEP" : "LINEAR");
    gltf_next(&gltf->channels);
    text_add(&gltf->channels.text, "{\"sampler\":%d,\"target\":{\"node\":%d,\"path\":\"%s\"}}", sampler, node,
             property);
}

/* ---- The file ---- */

static void add_list(Text *json, const char *name, const GltfList *list)
{
    if (list->count) text_add(json, ",\n\"%s\":[\n%s]", name, list->text.text);
}

static void add_json(const Gltf *gltf, Text *json)
{
    text_add(json, "{\"asset\":{\"version\":\"2.0\"," MARK_GLB(
                       SLENDER_VERSION) "},\n\"scene\":0,\"scenes\":[{\"nodes\":[0]}]");
    text_add(json, ",\n\"buffers\":[{\"byteLength\":%zu}]", gltf->buffer.size);
    add_list(json, "bufferViews", &gltf->views);
    add_list(json, "accessors", &gltf->accessors);
    add_list(json, "materials", &gltf->materials);
    add_list(json, "meshes", &gltf->meshes);
    add_list(json, "nodes", &gltf->nodes);
    if (gltf->channels.count)
        text_add(json, ",\n\"animations\":[{\"name\":\"run\",\"samplers\":[\n%s],\"channels\":[\n%s]}]",
                 gltf->samplers.text.text, gltf->channels.text.text);
    text_add(json, "}\n");
}

/* Chunks: their size, what they are, and themselves, in whole words. */
bool gltf_write(const Gltf *gltf, Bytes *file, Error *err)
{
    const double LARGEST = 4e9; /* bytes: sizes have 32 bits */
    Text json = {0};
    add_json(gltf, &json);
    while (json.length % 4) text_add(&json, " ");
    if ((double)gltf->buffer.size + (double)json.length > LARGEST) {
        mem_free(json.text);
        return error_set(err, "a .glb has 4 GB at most: --frames N takes fewer of them");
    }
    uint32_t binary = (uint32_t)gltf->buffer.size, text = (uint32_t)json.length;
    bytes_add_text(file, "glTF");
    bytes_add_u32(file, 2);
    bytes_add_u32(file, 12 + 8 + text + 8 + binary);
    bytes_add_u32(file, text);
    bytes_add_text(file, "JSON");
    bytes_add(file, json.text, text);
    bytes_add_u32(file, binary);
    bytes_add(file, "BIN\0", 4);
    bytes_add(file, gltf->buffer.data, binary);
    mem_free(json.text);
    return true;
}

void gltf_clear(Gltf *gltf)
{
    GltfList *lists[] = {&gltf->views, &gltf->accessors, &gltf->materials, &gltf->meshes,
                         &gltf->nodes, &gltf->samplers,  &gltf->channels};
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) mem_free(lists[k]->text.text);
    bytes_clear(&gltf->buffer);
    *gltf = (Gltf){0};
}
