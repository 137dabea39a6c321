#include "job/sources.h"
#include "base/memory.h"
#include "job/pose_rows.h"
#include "model/frame_flux.h"
#include "model/within.h"
#include <math.h>
#include <string.h>

/* Those that can be drawn, in order, field[model->fields->count]; returns how many. */
static int with_shapes(const Model *model, int *field)
{
    int count = 0;
    for (int k = 0; model->fields && k < model->fields->count; k++)
        if (flux_field_has_shape(model->fields->items[k])) field[count++] = k;
    return count;
}

static int *find_sources(const Model *model, Arrays *list, int *count)
{
    size_t most = model->fields ? (size_t)model->fields->count : 0;
    int *field = arrays_keep(list, mem_alloc(most, sizeof *field));
    *count = with_shapes(model, field);
    return field;
}

void sources_add_poses(const Model *model, const Snapshot *shot, Arrays *list)
{
    const FluxBlocks *blocks = &model->flux_blocks;
    int count, *field = find_sources(model, list, &count);
    if (!count) return;
    double *rows = arrays_numbers(list, 12 * (size_t)count);
    for (int s = 0; s < count; s++) {
        int k = field[s];
        RigidPose pose;
        FluxPlace place = {shot->at.time, shot->p + blocks->move + 3 * k, shot->p + blocks->turn + 3 * k};
        bool known =
            shot->p[blocks->scale + k] != 0 && flux_field_pose(model->fields->items[k], place, &pose, NULL);
        if (known)
            pose_put_row(&pose, rows + 12 * s);
        else
            for (int i = 0; i < 12; i++) rows[12 * s + i] = NAN;
    }
    arrays_add(list, array_float("source_pose", "1, m", rows, 2, count, 12));
}

void sources_add_numbers(const Model *model, const Snapshot *shot, Arrays *list)
{
    const FluxBlocks *blocks = &model->flux_blocks;
    int count = model->fields ? model->fields->count : 0;
    if (!count) return;
    double *uniform = arrays_numbers(list, 3), *rows = arrays_numbers(list, FRAME_FLUX_WIDTH * (size_t)count);
    memcpy(uniform, shot->p + blocks->uniform, 3 * sizeof *uniform);
    for (int k = 0; k < count; k++) frame_flux_numbers(blocks, shot->p, k, rows + FRAME_FLUX_WIDTH * k);
    arrays_add(list, array_float("flux_uniform", "T", uniform, 2, 1, 3));
    arrays_add(list, array_float("flux_sources", "1, m, rad", rows, 2, count, FRAME_FLUX_WIDTH));
}

static char *path_of(Arrays *list, const FluxField *field, const char *what)
{
    return arrays_keep(list, mem_format("sources/%s/%s", flux_field_name(field), what));
}

static void add_shape(const FluxField *field, Arrays *list)
{
    MeshFile shape;
    double *pole;
    flux_field_shape(field, &shape, &pole);
    arrays_keep(list, pole);
    double *points =
        arrays_keep(list, mem_copy(shape.vertices[0], 3 * (size_t)shape.vertex_count, sizeof *points));
    int *faces = arrays_keep(list, mem_copy(shape.faces[0], 3 * (size_t)shape.face_count, sizeof *faces));
    arrays_add(list, array_text(path_of(list, field, "kind"), flux_field_kind(field)));
    arrays_add(list, array_float(path_of(list, field, "points"), "m", points, 2, shape.vertex_count, 3));
    arrays_add(list, array_int(path_of(list, field, "faces"), faces, 2, shape.face_count, 3));
    arrays_add(list, array_float(path_of(list, field, "pole"), "", pole, 1, shape.face_count, 0));
    mesh_file_clear(&shape);
}

void sources_add(const Model *model, Arrays *list)
{
    int count, *field = find_sources(model, list, &count);
    char *names = mem_text("");
    for (int s = 0; s < count; s++) {
        add_shape(model->fields->items[field[s]], list);
        names = mem_join(names, flux_field_name(model->fields->items[field[s]]), "\n");
    }
    arrays_keep(list, names);
    if (count) arrays_add(list, array_text("source_names", names));
}

static void warn(void *self, const char *sentence)
{
    host_warn(self, "%s", sentence);
}

void sources_tell_within(Run *run, const Snapshot *shot, int frame)
{
    Model *model = run->model;
    if (!model->fields || model->fields->count == 0) return;
    const char *name = shot->load_case->name;
    char *where = model->job->motion ? mem_format("%s, t = %g s: the body is in", name, shot->at.time)
                                     : mem_format("%s, frame %d: the body is in", name, frame);
    model_tell_within(model, shot->p, shot->at.time, shot->at.x, where, warn, (void *)run->host);
    mem_free(where);
}
