/* Selections, loads, poses and targets. */
#include "base/memory.h"
#include "base/vec3.h"
#include "io/image.h"
#include "model/build.h"
#include "surface/loads.h"
#include <math.h>
#include <string.h>

bool build_selection(const Build *b, Key at, const SelectionScene *scene, Indices *found)
{
    if (!scene) {
        *found = (Indices){b->mesh->vertex_count, mem_alloc((size_t)b->mesh->vertex_count, sizeof(int))};
        for (int v = 0; v < found->count; v++) found->items[v] = v;
        return true;
    }
    Selection selection = {.vertices = {scene->vertices_count, scene->vertices},
                           .group = scene->group,
                           .boundary = scene->boundary};
    if ((selection.has_box = scene->box_count > 0)) memcpy(selection.box, scene->box, sizeof selection.box);
    if ((selection.has_ball = scene->ball != NULL)) {
        memcpy(selection.center, scene->ball->center, sizeof selection.center);
        selection.radius = scene->ball->radius;
    }
    Error err;
    return select_vertices(b->mesh, &selection, found, &err) || yaml_refuse(b->file, at.text, "%s", err.text);
}

bool build_axes(const Build *b, Key at, const char *text, bool axes[3])
{
    bool ok = *text != 0;
    memset(axes, 0, 3 * sizeof *axes);
    for (const char *c = text; ok && *c; c++) {
        ok = strchr("xyz", *c) && !axes[*c - 'x'];
        if (ok) axes[*c - 'x'] = true;
    }
    return ok ||
           yaml_refuse(b->file, at.text, "axes is '%s'; it must be some of xyz, each once at most", text);
}

/* ---- Dead loads ---- */

static bool add_load(const Build *b, Key at, const LoadScene *entry, double *load)
{
    Indices on = {0};
    bool ok = build_selection(b, key("%s.on", at.text), entry->on, &on);
    if (ok && !isnan(entry->line[0]))
        ok = loads_on_edges(b->mesh, &on, entry->line, load) > 0 ||
             yaml_refuse(b->file, at.text, "no boundary edge has both ends among these vertices");
    else if (ok && !isnan(entry->area[0]))
        ok = loads_on_faces(b->mesh, &on, entry->area, load) > 0 ||
             yaml_refuse(b->file, at.text, "no face has all corners among these vertices");
    else if (ok)
        loads_on_vertices(&on, entry->force, load);
    mem_free(on.items);
    return ok;
}

bool build_loads(const Build *b, Key at, const LoadScene *loads, int count, double *load)
{
    bool ok = true;
    memset(load, 0, 3 * (size_t)b->mesh->vertex_count * sizeof *load);
    for (int k = 0; k < count; k++) ok = add_load(b, key("%s[%d]", at.text, k), &loads[k], load) && ok;
    return ok;
}

/* ---- Poses and targets ---- */

/* The vertices of a file in another state; fits NULL: whatever its faces are. */
static bool places_from_file(const Build *b, Key at, const char *path, double scale, BuildFits *fits,
                             double (*place)[3])
{
    MeshFile file = {0};
    if (!build_state(b, at, path, scale, &file)) return false;
    bool ok = !fits || fits(b->mesh, &file) ||
              yaml_refuse(b->file, at.text, "%s has other faces than the mesh", path);
    for (int v = 0; ok && v < b->mesh->vertex_count; v++)
        memcpy(place[v], file.vertices[mesh_row(b->mesh, file.vertex_count, v)], sizeof *place);
    mesh_file_clear(&file);
    return ok;
}

bool build_pose(const Build *b, Key at, const PoseScene *scene, BuildFits *fits, double (*place)[3])
{
    if (!scene) return true;
    if (scene->file)
        return places_from_file(b, key("%s.file", at.text), scene->file, scene->scale, fits, place);
    return build_vectors_at(b, key("%s.formula", at.text), scene->formula, scene->where, scene->where_count,
                            b->mesh->rest[0], b->mesh->vertex_count, place[0]);
}

static bool target_from_image(const Build *b, Key at, const TargetScene *scene, double (*target)[3])
{
    Image image = {0};
    Error err;
    if (!image_read(scene->height_map, &image, &err)) return yaml_refuse(b->file, at.text, "%s", err.text);
    double low[3], high[3];
    mesh_bounding_box(b->mesh, low, high);
    for (int v = 0; v < b->mesh->vertex_count; v++) {
        const double *x = b->mesh->rest[v];
        double u = (x[0] - low[0]) / (high[0] - low[0]), w = (high[1] - x[1]) / (high[1] - low[1]);
        target[v][2] = scene->height * image_sample(&image, u, w);
    }
    image_clear(&image);
    return true;
}

static double segment_distance(const double *segment, const double *x)
{
    double ax = segment[2] - segment[0], ay = segment[3] - segment[1], bx = x[0] - segment[0],
           by = x[1] - segment[1];
    double length2 = ax * ax + ay * ay, s = length2 > 0 ? (ax * bx + ay * by) / length2 : 0;
    s = fmin(fmax(s, 0), 1);
    return hypot(bx - s * ax, by - s * ay);
}

/* A ridge (1 + cos(pi d/width))/2 of the distance to the nearest segment: `width` wide at half its height. */
static void target_from_strokes(const Build *b, const TargetScene *scene, double (*target)[3])
{
    for (int v = 0; v < b->mesh->vertex_count; v++) {
        double d = INFINITY;
        for (int k = 0; k < scene->strokes_count; k++)
            d = fmin(d, segment_distance(scene->strokes[k], b->mesh->rest[v]));
        target[v][2] = d < scene->width ? scene->height * (1 + cos(M_PI * d / scene->width)) / 2 : 0;
    }
}

bool build_target(const Build *b, Key at, const TargetScene *scene, double (*target)[3])
{
    memcpy(target, b->mesh->rest, (size_t)b->mesh->vertex_count * sizeof *target);
    if ((scene->height_map || scene->strokes_count) && isnan(scene->height))
        return yaml_refuse(b->file, at.text, "a height map and strokes need `height`, e.g. height: 5 mm");
    if (scene->strokes_count && isnan(scene->width))
        return yaml_refuse(b->file, at.text, "strokes need `width`, e.g. width: 6 mm");
    bool ok = true;
    if (scene->file)
        ok = places_from_file(b, key("%s.file", at.text), scene->file, scene->scale, NULL, target);
    else if (scene->height_map)
        ok = target_from_image(b, key("%s.height_map", at.text), scene, target);
    else if (scene->strokes_count)
        target_from_strokes(b, scene, target);
    else
        ok = build_vectors_at(b, key("%s.formula", at.text), scene->formula, scene->where, scene->where_count,
                              b->mesh->rest[0], b->mesh->vertex_count, target[0]);
    return ok;
}
