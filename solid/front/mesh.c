/* Meshes of tetrahedra, from files or made. */
#include "solid/front/mesh.h"
#include "base/memory.h"
#include "model/build.h"
#include "solid/fill.h"
#include "solid/shapes.h"
#include <math.h>

/* ---- Which keys go with what ---- */

enum { SIZE = 1, CELLS = 2, N = 4, PATTERN = 8, THICKNESS = 16, LAYERS = 32, SCALE = 64 };

static const BuildKey mesh_keys[] = {{"size", "[60 mm, 20 mm, 5 mm] of a box or plate, 80 mm of others"},
                                     {"cells", "along x, y and z, e.g. [12, 4, 1]"},
                                     {"n", NULL},
                                     {"pattern", NULL},
                                     {"thickness", NULL},
                                     {"layers", NULL},
                                     {"scale", NULL},
                                     {NULL, NULL}};

/* A default counts as not given: it does no harm where it has no meaning. */
static unsigned given_keys(const SolidMeshScene *scene)
{
    return (scene->size_count ? SIZE : 0) | (scene->cells_count ? CELLS : 0) |
           (scene->n != YAML_ABSENT ? N : 0) | (scene->pattern != PATTERN_RIGHT ? PATTERN : 0) |
           (!isnan(scene->thickness) ? THICKNESS : 0) | (scene->layers != 1 ? LAYERS : 0) |
           (scene->scale != 1 ? SCALE : 0);
}

/* What a source needs to make its mesh. */
typedef struct Make {
    const SolidMeshScene *scene;
    YamlFile *yaml;
    const char *at;
    MeshReport sheet; /* of the triangles that are made thick or filled */
    Error *err;       /* without a sentence where yaml has been told already */
} Make;

static SolidShapeDef def_of(const SolidMeshScene *scene)
{
    return (SolidShapeDef){scene->size[0], scene->thickness, scene->n == YAML_ABSENT ? 0 : scene->n,
                           scene->layers};
}

static bool make_box(Make *m, MeshFile *file)
{
    return solid_shape_box(m->scene->size, m->scene->cells, file, m->err);
}
static bool make_plate(Make *m, MeshFile *file)
{
    return solid_shape_plate(m->scene->size, m->scene->cells, (ShapePattern)m->scene->pattern, file, m->err);
}
static bool make_hand(Make *m, MeshFile *file)
{
    return solid_shape_hand(def_of(m->scene), file, m->err);
}
static bool make_heart(Make *m, MeshFile *file)
{
    return solid_shape_heart(def_of(m->scene), file, m->err);
}
static bool make_starfish(Make *m, MeshFile *file)
{
    return solid_shape_starfish(def_of(m->scene), file, m->err);
}
static bool read_file(Make *m, MeshFile *file)
{
    return build_read_mesh(m->scene->file, m->scene->scale, file, m->err);
}

static bool make_extruded(Make *m, MeshFile *file)
{
    if (isnan(m->scene->thickness))
        return error_set(m->err, "what is extruded needs `thickness`: along its normals, e.g. 2 mm");
    Mesh *sheet = build_mesh(m->scene->extrude, m->yaml, key("%s.extrude", m->at).text, &m->sheet);
    bool ok = sheet && solid_shape_extrude(sheet, m->scene->thickness, m->scene->layers, file, m->err);
    mesh_destroy(sheet);
    return ok;
}

static bool make_filled(Make *m, MeshFile *file)
{
    MeshFile triangles = {0};
    Mesh *surface = NULL;
    if (build_read_mesh(m->scene->surface, m->scene->scale, &triangles, m->err) &&
        mesh_file_check_triangles(&triangles, m->err))
        surface = mesh_create(&triangles, 0, &m->sheet, m->err);
    bool ok = surface && solid_fill(surface, m->scene->size[0], file, m->err);
    if (ok) mem_free(file->path), file->path = mem_text(m->scene->surface);
    mesh_destroy(surface);
    mesh_file_clear(&triangles);
    return ok;
}

/* A source of meshes: the keys that it takes, the number of lengths in `size`. */
typedef struct Source {
    BuildTakes of;
    int lengths;
    const char *key; /* where what is wrong with it stands; NULL: at the mesh */
    bool (*make)(Make *m, MeshFile *file);
} Source;

static const Source shapes[SOLID_SHAPES] = {
    [SOLID_BOX] = {{"a box", SIZE | CELLS}, 3, NULL, make_box},
    [SOLID_PLATE] = {{"a plate", SIZE | CELLS | PATTERN}, 3, NULL, make_plate},
    [SOLID_HAND] = {{"a hand", SIZE | N | THICKNESS | LAYERS}, 1, NULL, make_hand},
    [SOLID_HEART] = {{"a heart", SIZE | N | THICKNESS | LAYERS}, 1, NULL, make_heart},
    [SOLID_STARFISH] = {{"a starfish", SIZE | N | THICKNESS | LAYERS}, 1, NULL, make_starfish}};
static const Source from_file = {{"a mesh from a file", SCALE}, 0, "file", read_file};
static const Source extruded = {{"what is extruded", THICKNESS | LAYERS}, 0, "extrude", make_extruded};
static const Source filled = {{"a surface that is filled", SIZE | SCALE}, 1, "surface", make_filled};

static bool check_keys(const SolidMeshScene *scene, const Source *source, YamlFile *yaml, const char *at)
{
    bool ok = build_check_keys(mesh_keys, source->of, given_keys(scene), yaml, at);
    if (ok && scene->size_count != source->lengths)
        return yaml_refuse(yaml, key("%s.size", at).text, "%s has %s", source->of.name,
                           source->lengths == 3 ? "three lengths: [60 mm, 20 mm, 5 mm]" : "one size: 80 mm");
    return ok;
}

/* ---- The mesh ---- */

static void add_warnings(MeshReport *to, MeshReport *from)
{
    for (int i = 0; i < from->warning_count; i++) mesh_warn(to, "%s", from->warnings[i]);
    mesh_report_clear(from);
}

Tets *solid_read_mesh(const SolidMeshScene *scene, YamlFile *yaml, const char *at, int order,
                      MeshReport *report)
{
    const Source *source = scene->file      ? &from_file
                           : scene->extrude ? &extruded
                           : scene->surface ? &filled
                                            : &shapes[scene->shape];
    if (report) *report = (MeshReport){0};
    if (!check_keys(scene, source, yaml, at)) return NULL;
    MeshFile file = {0};
    Error err = {""};
    Make make = {scene, yaml, at, .err = &err};
    Tets *tets = source->make(&make, &file) ? tets_create(&file, order, report, &err) : NULL;
    Key place = source->key ? key("%s.%s", at, source->key) : key("%s", at);
    if (!tets && err.text[0]) yaml_refuse(yaml, place.text, "%s", err.text);
    add_warnings(report, &make.sheet);
    mesh_file_clear(&file);
    return tets;
}
