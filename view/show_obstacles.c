#include "view/show_obstacles.h"
#include "base/memory.h"
#include <string.h>

static const Color plain = {0.82, 0.88, 0.96, 1}, line = {0.45, 0.53, 0.65, 1};
static const Color north = {0.80, 0.27, 0.23, 1}, south = {0.25, 0.42, 0.72, 1},
                   steel = {0.78, 0.78, 0.80, 1}, copper = {0.80, 0.52, 0.33, 1};
static const double LINE = 2; /* pixels */

/* ---- Reading ---- */

/* Of such a shape. */
typedef struct Part {
    const char *what;
    ArrayType type;
    int rank, width;
} Part;

static bool read_part(ShowData *data, const char *group, const char *name, Part part, Array *array,
                      Error *err)
{
    char *path = mem_format("slender/%s/%s/%s", group, name, part.what);
    bool ok = result_read_as(data->result, path, part.type, part.rank, part.width, array, err);
    mem_free(path);
    if (ok) show_keep(data, *array);
    return ok;
}

static const Part points_part = {"points", ARRAY_FLOAT64, 2, 3}, faces_part = {"faces", ARRAY_INT32, 2, 3},
                  pole_part = {"pole", ARRAY_FLOAT64, 1, 0}, kind_part = {"kind", ARRAY_TEXT, 1, 0};

static bool read_obstacle(ShowData *data, const char *group, const char *name, ShowObstacle *obstacle,
                          Error *err)
{
    Array points, faces;
    if (!read_part(data, group, name, points_part, &points, err) ||
        !read_part(data, group, name, faces_part, &faces, err))
        return false;
    *obstacle = (ShowObstacle){points.dims[0], faces.dims[0], (void *)points.data, (void *)faces.data,
                               .pole = NULL,   .name = name,  .kind = NULL};
    for (size_t i = 0; i < array_count(&faces); i++) {
        int point = ((const int *)faces.data)[i];
        if (point < 0 || point >= points.dims[0])
            return error_set(err, "the faces of %s/%s name points that it does not have", group, name);
    }
    return true;
}

/* What a source is beside its surface. */
static bool read_source(ShowData *data, const char *name, ShowObstacle *source, Error *err)
{
    Array pole, kind;
    if (!read_part(data, "sources", name, pole_part, &pole, err) ||
        !read_part(data, "sources", name, kind_part, &kind, err))
        return false;
    source->pole = pole.data, source->kind = kind.data;
    return pole.dims[0] == source->face_count ||
           error_set(err, "the poles of sources/%s are not those of its faces", name);
}

Color show_obstacle_color(const ShowObstacle *one, int face)
{
    if (!one->pole) return plain;
    if (strcmp(one->kind, "magnet") != 0) return copper;
    double part = fmin(fabs(one->pole[face]), 1);
    Color end = one->pole[face] > 0 ? north : south;
    return (Color){steel.r + part * (end.r - steel.r), steel.g + part * (end.g - steel.g),
                   steel.b + part * (end.b - steel.b), 1};
}

static void merge(ShowObstacles *o)
{
    for (int k = 0; k < o->count; k++) o->face_count += o->list[k].face_count;
    int(*face)[3] = o->faces = show_block(o->data, (size_t)o->face_count, sizeof *o->faces);
    Color *color = o->colors = show_block(o->data, (size_t)o->face_count, sizeof *o->colors);
    for (int k = 0; k < o->count; k++) {
        const ShowObstacle *one = &o->list[k];
        for (int f = 0; f < one->face_count; f++, face++) {
            for (int i = 0; i < 3; i++) (*face)[i] = o->point_count + one->faces[f][i];
            *color++ = show_obstacle_color(one, f);
        }
        o->point_count += one->point_count;
    }
}

/* Those that a text of the result names, line by line, behind the ones that are there. */
static bool read_group(ShowObstacles *o, const char *names_path, const char *group, bool sources, Error *err)
{
    Array names;
    ShowData *data = o->data;
    if (!result_has(data->result, names_path)) return true;
    if (!result_read_as(data->result, names_path, ARRAY_TEXT, 1, 0, &names, err)) return false;
    char *text = show_keep(data, names), *rest = NULL;
    size_t most = (size_t)o->count + strlen(text) + 1; /* a name has a byte at least */
    ShowObstacle *list = show_block(data, most, sizeof *list);
    if (o->count) memcpy(list, o->list, (size_t)o->count * sizeof *list);
    o->list = list;
    for (char *name = strtok_r(text, "\n", &rest); name; name = strtok_r(NULL, "\n", &rest)) {
        ShowObstacle *one = &o->list[o->count++];
        if (!read_obstacle(data, group, name, one, err)) return false;
        if (sources && !read_source(data, name, one, err)) return false;
    }
    return true;
}

bool show_obstacles_read(ShowObstacles *o, ShowData *data, Error *err)
{
    *o = (ShowObstacles){.data = data};
    if (!read_group(o, "slender/obstacle_names", "obstacles", false, err)) return false;
    o->obstacles = o->count;
    if (!read_group(o, "slender/source_names", "sources", true, err)) return false;
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

/* [count][12] of a dataset of frames; NULL: there is none, or another. */
static const double *poses_at(const ShowObstacles *o, const char *path, int count, int frame)
{
    Array poses;
    Result *result = o->data->result;
    if (frame < 0) frame = result_step_count(result) - 1;
    if (frame < 0 || !result_has(result, path) || !result_read_rows(result, path, frame, 1, &poses, NULL))
        return NULL;
    bool fits = poses.type == ARRAY_FLOAT64 && array_count(&poses) == 12 * (size_t)count;
    const double *numbers = show_keep(o->data, poses);
    return fits ? numbers : NULL;
}

const double (*show_obstacles_poses(const ShowObstacles *o, int frame))[12]
{
    static const double still[12] = {[0] = 1, [5] = 1, [10] = 1};
    const double *moved = poses_at(o, "slender/frames/obstacle_pose", o->obstacles, frame),
                 *sources = poses_at(o, "slender/frames/source_pose", o->count - o->obstacles, frame);
    double(*poses)[12] = show_block(o->data, (size_t)o->count, sizeof *poses);
    for (int k = 0; k < o->count; k++) {
        const double *all = k < o->obstacles ? moved : sources;
        int row = k < o->obstacles ? k : k - o->obstacles;
        memcpy(poses[k], all ? all + 12 * row : still, sizeof still);
    }
    return (const double(*)[12])poses;
}

Surroundings show_obstacles_at(const ShowObstacles *o, int frame)
{
    if (o->count == 0) return (Surroundings){0};
    const double(*poses)[12] = show_obstacles_poses(o, frame);
    double(*x)[3] = show_block(o->data, (size_t)o->point_count, sizeof *x);
    RasterMesh *mesh = show_block(o->data, 1, sizeof *mesh);
    *mesh = (RasterMesh){.vertex_count = o->point_count,
                         .face_count = o->face_count,
                         .vertices = (const double(*)[3])x,
                         .faces = (const int(*)[3])o->faces,
                         .face_colors = o->colors,
                         .color = plain,
                         .edge_color = line,
                         .edge_width = LINE,
                         .one_sided = true};
    for (int k = 0; k < o->count; k++)
        for (int v = 0; v < o->list[k].point_count; v++, x++) place(poses[k], o->list[k].points[v], *x);
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
    const double LARGEST[] = {1.5, 4}, NEAR[] = {0.5, 2}; /* of the way's size: of obstacles, of sources */
    if (!around->obstacles) return;
    double(*found)[3] = show_block(o->data, (size_t)o->point_count, sizeof *found);
    double size = vec3_length(vec3_sub(way.high, way.low));
    const double(*x)[3] = around->obstacles->vertices;
    around->near = (const double(*)[3])found;
    for (int k = 0; k < o->count; x += o->list[k++].point_count) {
        ShowWay one = show_way();
        int more = o->list[k].point_count;
        show_way_add(&one, x, more);
        bool source = k >= o->obstacles;
        if (vec3_length(vec3_sub(one.high, one.low)) > LARGEST[source] * size ||
            gap_of(one, way) > NEAR[source] * size)
            continue;
        memcpy(found + around->near_count, x, (size_t)more * sizeof *x);
        around->near_count += more;
    }
}
