#include "view/show_holds.h"
#include <math.h>
#include <string.h>

/* Rows of 3x4 matrices: the columns tangent, n1, n2 and place. */
static Hold hold_of(const double row[12])
{
    Hold hold = {0};
    for (int i = 0; i < 3; i++) {
        hold.n1[i] = row[4 * i + 1], hold.n2[i] = row[4 * i + 2];
        hold.at[i] = row[4 * i + 3];
    }
    return hold;
}

/* Matrices of `count` holds: as the scene says them, and, where they move, in the frames up to one. */
typedef struct Poses {
    int count, frames;
    const double *stands, *moved; /* [count][12], [frames][count][12]; NULL: not known */
} Poses;

/* So many rows of a dataset, the first ones (0: it has no rows); NULL: it is not there. */
static const double *read_rows(ShowData *data, const char *path, int rows, int *count)
{
    Array array;
    if (!result_has(data->result, path)) return NULL;
    if (!(rows ? result_read_rows(data->result, path, 0, rows, &array, NULL)
               : result_read(data->result, path, &array, NULL)))
        return NULL;
    *count = array.type == ARRAY_FLOAT64 ? (int)(array_count(&array) / 12) / (rows ? rows : 1) : 0;
    return show_keep(data, array);
}

static Poses read_poses(ShowData *data, int frame)
{
    if (frame < 0) frame = result_step_count(data->result) - 1;
    Poses poses = {.frames = frame + 1};
    poses.stands = read_rows(data, "slender/rod/support_pose", 0, &poses.count);
    if (poses.frames > 0)
        poses.moved = read_rows(data, "slender/frames/support_pose", poses.frames, &poses.count);
    return poses;
}

static void put_place(const double row[12], double at[3])
{
    for (int i = 0; i < 3; i++) at[i] = row[4 * i + 3];
}

/* Through the frames; of one that stays as it is in these, from where the scene has it before it moves. */
static void put_way(ShowData *data, const Poses *poses, int k, Hold *hold)
{
    int count = poses->frames;
    double(*way)[3] = show_block(data, (size_t)count + 1, sizeof *way), extent[2] = {0};
    put_place(poses->stands + 12 * k, way[0]);
    for (int n = 0; n < count; n++) put_place(poses->moved + 12 * (n * poses->count + k), way[n + 1]);
    for (int n = 1; n <= count; n++)
        for (int i = 0; i < 3; i++) {
            extent[0] = fmax(extent[0], fabs(way[n][i] - way[0][i]));
            extent[1] = fmax(extent[1], fabs(way[n][i] - way[1][i]));
        }
    bool moves = extent[1] > 0;
    if (!(extent[0] > 0)) return;
    hold->way = (const double(*)[3])way + moves;
    hold->way_count = count + !moves;
}

static void read_outline(ShowData *data, Holds *holds)
{
    static const char OUTLINE[] = "slender/rod/section_outline";
    Array outline;
    if (!result_has(data->result, OUTLINE) || !result_read(data->result, OUTLINE, &outline, NULL)) return;
    bool fits = outline.type == ARRAY_FLOAT64 && outline.rank == 2 && outline.dims[1] == 2;
    holds->outline_count = fits ? outline.dims[0] : 0;
    holds->outline = show_keep(data, outline);
}

Holds show_holds(ShowData *data, int frame)
{
    Holds holds = {0};
    Poses poses = read_poses(data, frame);
    if (!poses.stands || poses.count > HOLDS_MOST) return holds;
    const double *rows = poses.moved ? poses.moved + 12 * (poses.frames - 1) * poses.count : poses.stands;
    Hold *items = show_block(data, (size_t)poses.count, sizeof *items);
    for (int k = 0; k < poses.count; k++) {
        items[k] = hold_of(rows + 12 * k);
        if (poses.moved) put_way(data, &poses, k, &items[k]);
    }
    holds.count = poses.count, holds.items = items;
    read_outline(data, &holds);
    return holds;
}

static void add_squares(ShowData *data, int strand_count, const int *strands, CurvesScene *scene)
{
    static const char HELD[] = "slender/rod/held";
    int from = 0;
    while (from + 1 < scene->set_count && isnan(scene->sets[from].points[0][0]))
        from++; /* a target of some points */
    const double(*points)[3] = scene->sets[from].points;
    double(*held)[3] = show_block(data, (size_t)strand_count + 1, sizeof *held);
    Array array;
    int count = strand_count;
    for (int k = 0; k < count; k++) memcpy(held[k], points[strands[k]], sizeof *held);
    if (result_has(data->result, HELD) && result_read(data->result, HELD, &array, NULL)) {
        if (array_is(&array, ARRAY_FLOAT64, 1, 3)) memcpy(held[count++], array.data, sizeof *held);
        array_clear(&array);
    }
    scene->clamps = (const double(*)[3])held, scene->clamp_count = count;
}

void show_clamps(ShowData *data, int strand_count, const int *strands, CurvesScene *scene)
{
    static const char SUPPORTS[] = "slender/rod/supports";
    Array array;
    if (!curves_holds(scene, -1)) add_squares(data, strand_count, strands, scene);
    if (!result_has(data->result, SUPPORTS) || !result_read(data->result, SUPPORTS, &array, NULL)) return;
    if (array.type == ARRAY_TEXT && strstr(array.data, "pinned")) scene->clamps_name = "held";
    array_clear(&array);
}
