#include "job/obstacles.h"
#include "job/pose_rows.h"
#include "world/poses.h"
#include <math.h>
#include <string.h>

static const char KIND[] = "obstacles";

/* The poses of a time. The caller destroys them. */
static Poses poses_at(const World *world, double time)
{
    Poses poses = poses_create(world->obstacles, world->obstacle_count);
    poses_update(&poses, &(Point){.time = time});
    return poses;
}

void obstacles_add_poses(const Model *model, double time, Arrays *list)
{
    const World *world = model->world;
    if (!world || world->obstacle_count == 0) return;
    Poses poses = poses_at(world, time);
    if (poses.moves) {
        double *rows = arrays_numbers(list, 12 * (size_t)poses.count);
        for (int k = 0; k < poses.count; k++) pose_put_row(&poses.end[k], rows + 12 * k);
        arrays_add(list, array_float("obstacle_pose", "1, m", rows, 2, poses.count, 12));
    }
    poses_destroy(&poses);
}

/* ---- How far the body comes, as an obstacle sees it ---- */

typedef double Box[2][3];

/* A point of space, from an obstacle with that pose; NULL: as it is given. Points that are nowhere count as none. */
static void include(Box box, const double *pose, const double x[3])
{
    for (int i = 0; i < 3; i++) {
        double own = pose ? 0 : x[i];
        for (int j = 0; pose && j < 3; j++) own += pose[4 * j + i] * (x[j] - pose[4 * j + 3]);
        box[0][i] = fmin(box[0][i], own);
        box[1][i] = fmax(box[1][i], own);
    }
}

/* poses: [obstacle][12], or NULL. */
static void include_all(Box *boxes, int obstacles, const double *poses, const double *x, int points)
{
    for (int k = 0; k < obstacles; k++)
        for (int v = 0; v < points; v++) include(boxes[k], poses ? poses + 12 * k : NULL, x + 3 * v);
}

static void include_start(const Model *model, Box *boxes)
{
    const World *world = model->world;
    Arrays list = {0};
    obstacles_add_poses(model, model->time, &list);
    const double *poses = list.count ? list.arrays[0].data : NULL;
    double *place = arrays_numbers(&list, 3 * (size_t)model->point_count);
    include_all(boxes, world->obstacle_count, poses, world->body.rest[0], world->body.vertex_count);
    for (int c = 0; c < model->case_count; c++) {
        model->body->ops->places(model, model->cases[c].state.x, place);
        include_all(boxes, world->obstacle_count, poses, place, model->point_count);
    }
    arrays_clear(&list);
}

static bool include_frame(const Run *run, int frame, Box *boxes, Error *err)
{
    const Model *model = run->model;
    int obstacles = model->world->obstacle_count;
    Array x, poses;
    if (!journal_get(run->journal, "frame", frame, "x", &x, err)) return false;
    bool ok = journal_find(run->journal, "frame", frame, "obstacle_pose", &poses, err);
    if (ok && array_is(&x, ARRAY_FLOAT64, 2, 3)) {
        bool known = poses.data && array_count(&poses) == 12 * (size_t)obstacles;
        include_all(boxes, obstacles, known ? poses.data : NULL, x.data, x.dims[0]);
    }
    if (ok) array_clear(&poses);
    array_clear(&x);
    return ok;
}

/* By its own size on all sides: a picture shows more than the body. */
static void enlarge(Box box)
{
    double size = 0;
    for (int i = 0; i < 3; i++) size += (box[1][i] - box[0][i]) * (box[1][i] - box[0][i]);
    for (int i = 0; i < 3; i++) {
        box[0][i] -= sqrt(size);
        box[1][i] += sqrt(size);
    }
}

static bool find_boxes(const Run *run, Box *boxes, Error *err)
{
    int obstacles = run->model->world->obstacle_count, *frames, count;
    for (int k = 0; k < obstacles; k++)
        for (int i = 0; i < 3; i++) boxes[k][0][i] = INFINITY, boxes[k][1][i] = -INFINITY;
    include_start(run->model, boxes);
    bool ok = journal_indices(run->journal, "frame", &frames, &count, err);
    for (int k = 0; ok && k < count; k++) ok = include_frame(run, frames[k], boxes, err);
    if (ok) mem_free(frames);
    for (int k = 0; k < obstacles; k++) enlarge(boxes[k]);
    return ok;
}

/* ---- Surfaces ---- */

static char *path_of(Arrays *list, const Obstacle *obstacle, const char *what)
{
    return arrays_keep(list, mem_format("obstacles/%s/%s", obstacle->name, what));
}

static void add_surface(const Obstacle *obstacle, const Box box, Arrays *list)
{
    MeshFile surface;
    obstacle_surface(obstacle, box, &surface);
    double *points =
        arrays_keep(list, mem_copy(surface.vertices[0], 3 * (size_t)surface.vertex_count, sizeof *points));
    int *faces = arrays_keep(list, mem_copy(surface.faces[0], 3 * (size_t)surface.face_count, sizeof *faces));
    arrays_add(list, array_text(path_of(list, obstacle, "kind"), obstacle->ops->kind));
    arrays_add(list, array_float(path_of(list, obstacle, "points"), "m", points, 2, surface.vertex_count, 3));
    arrays_add(list, array_int(path_of(list, obstacle, "faces"), faces, 2, surface.face_count, 3));
    mesh_file_clear(&surface);
}

bool obstacles_put(const Run *run, Error *err)
{
    const World *world = run->model->world;
    if (!world || world->obstacle_count == 0) return true;
    Box *boxes = mem_alloc((size_t)world->obstacle_count, sizeof *boxes);
    Arrays list = {0};
    bool ok = find_boxes(run, boxes, err);
    char *names = mem_text("");
    for (int k = 0; k < world->obstacle_count; k++) {
        const Obstacle *obstacle = &world->obstacles[k];
        if (ok) add_surface(obstacle, (const double(*)[3])boxes[k], &list);
        names = mem_join(names, obstacle->name, "\n");
    }
    arrays_add(&list, array_text("obstacle_names", arrays_keep(&list, names)));
    ok = arrays_replace(&list, run->journal, KIND, ok ? err : NULL) && ok;
    mem_free(boxes);
    return ok;
}
