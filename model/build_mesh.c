/* Meshes of triangles, generated or from a file, and files that hold states of it. */
#include "base/memory.h"
#include "base/vec3.h"
#include "model/build.h"
#include "model/rows.h"
#include "surface/shapes.h"
#include <math.h>

/* ---- Which keys go with what ---- */

enum { SIZE = 1, CELLS = 2, N = 4, PATTERN = 8, SCALE = 16, WELD = 32 };

static const BuildKey mesh_keys[] = {{"size", "its lengths, e.g. [65 mm, 65 mm]"},
                                     {"cells", "along x and y, e.g. [64, 64]"},
                                     {"n", "the number of its divisions, e.g. 16"},
                                     {"pattern", NULL},
                                     {"scale", NULL},
                                     {"weld", NULL},
                                     {NULL, NULL}};

/* A default counts as not given: it does no harm where it has no meaning. */
static unsigned given_keys(const MeshScene *scene)
{
    return (scene->size_count ? SIZE : 0) | (scene->cells_count ? CELLS : 0) |
           (scene->n != YAML_ABSENT ? N : 0) | (scene->pattern != PATTERN_RIGHT ? PATTERN : 0) |
           (scene->scale != 1 ? SCALE : 0) | (scene->weld != 0 ? WELD : 0);
}

static bool make_sheet(const MeshScene *scene, MeshFile *file, Error *err)
{
    return shape_sheet(scene->size, scene->cells, (ShapePattern)scene->pattern, file, err);
}
static bool make_strip(const MeshScene *scene, MeshFile *file, Error *err)
{
    return shape_strip(scene->size[0], scene->size[1], scene->n, (ShapePattern)scene->pattern, file, err);
}
static bool make_hexagram(const MeshScene *scene, MeshFile *file, Error *err)
{
    return shape_hexagram(scene->size[0], scene->n, file, err);
}
static bool make_disc(const MeshScene *scene, MeshFile *file, Error *err)
{
    return shape_disc(scene->size[0], scene->n, file, err);
}
static bool make_kirigami(const MeshScene *scene, MeshFile *file, Error *err)
{
    return shape_kirigami(scene->size[0], scene->n, file, err);
}
static bool read_file(const MeshScene *scene, MeshFile *file, Error *err)
{
    return build_read_mesh(scene->file, scene->scale, file, err) && mesh_file_check_triangles(file, err);
}

/* A source of meshes: the keys that it takes, the number of lengths in `size`. */
typedef struct Source {
    BuildTakes of;
    int lengths;
    bool (*make)(const MeshScene *scene, MeshFile *file, Error *err);
} Source;

static const Source shapes[] = {[MESH_SHEET] = {{"a sheet", SIZE | CELLS | PATTERN}, 2, make_sheet},
                                [MESH_STRIP] = {{"a strip", SIZE | N | PATTERN}, 2, make_strip},
                                [MESH_HEXAGRAM] = {{"a hexagram", SIZE | N}, 1, make_hexagram},
                                [MESH_DISC] = {{"a disc", SIZE | N}, 1, make_disc},
                                [MESH_KIRIGAMI] = {{"a kirigami", SIZE | N}, 1, make_kirigami}};
static const Source from_file = {{"a mesh from a file", SCALE | WELD}, 0, read_file};

static Key list_keys(const BuildKey *keys, unsigned takes)
{
    Key list = {""};
    for (int k = 0; keys[k].key; k++)
        if (takes >> k & 1) list = key("%s%s%s", list.text, list.text[0] ? ", " : "", keys[k].key);
    return list;
}

bool build_check_keys(const BuildKey *keys, BuildTakes of, unsigned given, YamlFile *yaml, const char *at)
{
    bool ok = true;
    for (int k = 0; keys[k].key; k++) {
        bool takes = of.takes >> k & 1, has = given >> k & 1;
        if (has && !takes)
            ok = yaml_refuse(yaml, key("%s.%s", at, keys[k].key).text,
                             "%s does not take this key; it takes %s", of.name,
                             list_keys(keys, of.takes).text);
        if (takes && !has && keys[k].needed)
            ok = yaml_refuse(yaml, at, "%s needs `%s`: %s", of.name, keys[k].key, keys[k].needed);
    }
    return ok;
}

static bool check_keys(const MeshScene *scene, const Source *source, YamlFile *yaml, const char *at)
{
    bool ok = build_check_keys(mesh_keys, source->of, given_keys(scene), yaml, at);
    if (ok && scene->size_count != source->lengths)
        return yaml_refuse(yaml, key("%s.size", at).text, "%s has %s", source->of.name,
                           source->lengths == 2 ? "a length and a width: [65 mm, 65 mm]" : "one size: 40 mm");
    return ok;
}

/* ---- The mesh ---- */

Build build_start(const Scene *scene, const Mesh *mesh, double time, YamlFile *file)
{
    return (Build){.file = file,
                   .mesh = mesh,
                   .size = mesh ? mesh_diagonal(mesh) : 0,
                   .time = time,
                   .duration = scene_job(scene)->motion ? scene->time.step * scene->time.steps : 0,
                   .mesh_scale = 1};
}

Mesh *build_mesh(const MeshScene *scene, YamlFile *yaml, const char *at, MeshReport *report)
{
    const Source *source = scene->file ? &from_file : &shapes[scene->shape];
    MeshFile file = {0};
    Error err;
    Mesh *mesh = NULL;
    if (!check_keys(scene, source, yaml, at)) return NULL;
    if (!source->make(scene, &file, &err))
        yaml_refuse(yaml, key("%s%s", at, scene->file ? ".file" : "").text, "%s", err.text);
    else if (!(mesh = mesh_create(&file, scene->weld, report, &err)))
        yaml_refuse(yaml, at, "%s", err.text);
    mesh_file_clear(&file);
    return mesh;
}

bool build_read_mesh(const char *path, double scale, MeshFile *file, Error *err)
{
    if (!mesh_file_read(path, file, err)) return false;
    for (int i = 0; i < 3 * file->vertex_count; i++) file->vertices[i / 3][i % 3] *= scale;
    return true;
}

/* ---- States of the mesh ---- */

/* Of the box around the vertices, m. */
static double diagonal(const MeshFile *file)
{
    double low[3], high[3];
    for (int i = 0; i < 3 * file->vertex_count; i++) {
        double x = file->vertices[i / 3][i % 3];
        low[i % 3] = i < 3 ? x : fmin(low[i % 3], x);
        high[i % 3] = i < 3 ? x : fmax(high[i % 3], x);
    }
    return vec3_length(vec3_sub(vec3_load(high), vec3_load(low)));
}

/* As far from the size at rest, the file is in another unit. */
static const double FARTHEST = 100;

bool build_state(const Build *b, Key at, const char *path, double scale, MeshFile *file)
{
    Error err;
    double factor = isnan(scale) ? b->mesh_scale : scale, rest = mesh_diagonal(b->mesh);
    if (!build_read_mesh(path, factor, file, &err)) return yaml_refuse(b->file, at.text, "%s", err.text);
    double ratio = diagonal(file) / rest;
    bool ok = mesh_fits(b->mesh, file->vertex_count) ||
              yaml_refuse(b->file, at.text, "%s has %d vertices, and the mesh %d: they must be the same ones",
                          path, file->vertex_count, b->mesh->file_vertex_count);
    if (ok && !(ratio < FARTHEST && ratio > 1 / FARTHEST))
        ok = yaml_refuse(
            b->file, at.text,
            "%s is %.3g m across and the mesh %.3g m: give its `scale` (it was %g), e.g. 1 for a file in "
            "metres, 1.0e-3 for one in millimetres",
            path, ratio * rest, rest, factor);
    if (!ok) mesh_file_clear(file);
    return ok;
}
