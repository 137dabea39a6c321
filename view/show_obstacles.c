#include "view/show_obstacles.h"
#include "base/memory.h"
#include <string.h>

static const Color plain = {0.82, 0.88, 0.96, 1}, line = {0.45, 0.53, 0.65, 1};
static const double LINE = 2; /* pixels */

/* ---- Reading ---- */

static bool read_part(ShowData *data, const char *name, const char *what, ArrayType type, Array *array,
                      Error *err)
{
    char *path = mem_format("slender/obstacles/%s/%s", name, what);
    bool ok = result_read_as(data->result, path, type, 2, 3, array, err);
    mem_free(path);
    if (ok) show_keep(data, *array);
    return ok;
}

static bool read_obstacle(ShowData *data, const char *name, ShowObstacle *obstacle, Error *err)
{
    Array points, faces;
    if (!read_part(data, name, "points", ARRAY_FLOAT64, &points, err) ||
        !read_part(data, name, "faces", ARRAY_INT32, &faces, err))
        return false;
    *obstacle = (ShowObstacle){points.dims[0], faces.dims[0], (void *)points.data, (void *)faces.data};
    for (size_t i = 0; i < array_count(&faces); i++) {
        int point = ((const int *)faces.data)[i];
        if (point < 0 || point >= points.dims[0])
            return error_set(err, "the faces of obstacle '%s' name points that it does not have", name);
    }
    return true;
}

static void merge(ShowObstacles *o)
{
    for (int k = 0; k < o->count; k++) o->face_count += o->list[k].face_count;
    int(*face)[3] = o->faces = show_block(o->data, (size_t)o->face_count, sizeof *o->faces);
    for (int k = 0; k < o->count; k++) {
        const ShowObstacle *one = &o->list[k];
        for (int f = 0; f < one->face_count; f++, face++)
            for (int i = 0; i < 3; i++) (*face)[i] = o->point_count + one->faces[f][i];
        o->point_count += one->point_count;
    }
}

bool show_obstacles_read(ShowObstacles *o, ShowData *data, Error *err)
{
    Array names;
    *o = (ShowObstacles){.data = data};
    if (!result_has(data->result, "slender/obstacle_names")) return true;
    if (!result_read_as(data->result, "slender/obstacle_names", ARRAY_TEXT, 1, 0, &names, err)) return false;
    char *text = show_keep(data, names), *rest = NULL;
    o->list = show_block(data, strlen(text) + 1, sizeof *o->list); /* a name has a byte at least */
    for (char *name = strtok_r(text, "\n", &rest); name; name = strtok_r(NULL, "\n", &rest))
        if (!read_obstacle(data, name, &o->list[o->count++], err)) return false;
    merge(o);
    return true;
}

/* ---- Where they are ---- */

/* x = R X + s, rows of a 3x4 matrix. */
static void place(const double *pose, const double X[3], double x[3])
{
    for (int i = 0; i < 3; i++) {
        const double *row = pose + 4 * i;
        x[i] = row[0] * X[0] + row[1] * X[1] + row[2] * X[2] + row[3];
    }
}

/* [obstacle][12]; NULL: all stand still. */
static const double *poses_at(const ShowObstacles *o, int frame)
{
    static const char PATH[] = "slender/frames/obstacle_pose";
    Array poses;
    Result *result = o->data->result;
    if (frame < 0) frame = result_step_count(result) - 1;
    if (frame < 0 || !result_has(result, PATH) || !result_read_rows(result, PATH, frame, 1, &poses, NULL))
        return NULL;
    bool fits = poses.type == ARRAY_FLOAT64 && array_count(&poses) == 12 * (size_t)o->count;
    const double *numbers = show_keep(o->data, poses);
    return fits ? numbers : NULL;
}

Surroundings show_obstacles_at(const ShowObstacles *o, int frame)
{
    if (o->count == 0) return (Surroundings){0};
    const double *poses = poses_at(o, frame);
    double(*x)[3] = show_block(o->data, (size_t)o->point_count, sizeof *x);
    RasterMesh *mesh = show_block(o->data, 1, sizeof *mesh);
    *mesh = (RasterMesh){.vertex_count = o->point_count,
                         .face_count = o->face_count,
                         .vertices = (const double(*)[3])x,
                         .faces = (const int(*)[3])o->faces,
                         .color = plain,
                         .edge_color = line,
                         .edge_width = LINE,
                         .one_sided = true};
    for (int k = 0; k < o->count; k++)
        for (int v = 0; v < o->list[k].point_count; v++, x++) {
            const double *X = o->list[k].points[v];
            if (poses)
                place(poses + 12 * k, X, *x);
            else
                memcpy(*x, X, sizeof *x);
        }
    return (Surroundings){.obstacles = mesh};
}

/* ---- What of them is to be seen ---- */

ShowWay show_way(void)
{
    return (ShowWay){vec3(INFINITY, INFINITY, INFINITY), vec3(-INFINITY, -INFINITY, -INFINITY)};
}

void show_way_add(ShowWay *way, const double (*points)[3], int count)
{
    for (int i = 0; i < count; i++) {
        Vec3 p = vec3_load(points[i]);
        way->low = vec3(fmin(way->low.x, p.x), fmin(way->low.y, p.y), fmin(way->low.z, p.z));
        way->high = vec3(fmax(way->high.x, p.x), fmax(way->high.y, p.y), fmax(way->high.z, p.z));
    }
}

/* Between two boxes; 0 where they meet. */
static double gap_of(ShowWay a, ShowWay b)
{
    double x = fmax(a.low.x - b.high.x, b.low.x - a.high.x), y = fmax(a.low.y - b.high.y, b.low.y - a.high.y),
           z = fmax(a.low.z - b.high.z, b.low.z - a.high.z);
    return fmax(fmax(x, fmax(y, z)), 0);
}

void show_obstacles_find_near(const ShowObstacles *o, ShowWay way, Surroundings *around)
{
    const double LARGEST = 1.5, NEAR = 0.5; /* of the way's size */
    if (!around->obstacles) return;
    double(*found)[3] = show_block(o->data, (size_t)o->point_count, sizeof *found);
    double size = vec3_length(vec3_sub(way.high, way.low));
    const double(*x)[3] = around->obstacles->vertices;
    around->near = (const double(*)[3])found;
    for (int k = 0; k < o->count; x += o->list[k++].point_count) {
        ShowWay one = show_way();
        int more = o->list[k].point_count;
        show_way_add(&one, x, more);
        if (vec3_length(vec3_sub(one.high, one.low)) > LARGEST * size || gap_of(one, way) > NEAR * size)
            continue;
        memcpy(found + around->near_count, x, (size_t)more * sizeof *x);
        around->near_count += more;
    }
}
