/* Obstacles: what a scene says of each, sampled and read. */
#include "base/memory.h"
#include "io/image.h"
#include "model/build.h"
#include "world/obstacle_shapes.h"
#include <math.h>
#include <string.h>

static bool has_direction(const Build *b, Key at, const double v[3])
{
    return v[0] != 0 || v[1] != 0 || v[2] != 0 ||
           yaml_refuse(b->file, at.text, "it is 0 and has no direction");
}

static bool plane(const Build *b, Key at, const PlaneScene *scene, Obstacle *obstacle)
{
    if (!has_direction(b, key("%s.normal", at.text), scene->normal)) return false;
    *obstacle = obstacle_plane(scene->point, scene->normal);
    return true;
}

static bool cylinder(const Build *b, Key at, const CylinderScene *scene, Obstacle *obstacle)
{
    if (!has_direction(b, key("%s.axis", at.text), scene->axis)) return false;
    *obstacle = obstacle_cylinder(scene->point, scene->axis, scene->radius, scene->inside);
    return true;
}

static bool box(const Build *b, Key at, const BoxScene *scene, Obstacle *obstacle)
{
    double least = fmin(scene->half[0], fmin(scene->half[1], scene->half[2])),
           rounding = isnan(scene->rounding) ? least / 10 : scene->rounding;
    if (rounding > least)
        return yaml_refuse(b->file, key("%s.rounding", at.text).text,
                           "it is %g m, and the smallest half of the box %g m: it is at most that", rounding,
                           least);
    *obstacle = obstacle_box(scene->center, scene->half, rounding);
    return true;
}

/* ---- Height fields ---- */

/* height[cells[0] + 1][cells[1] + 1] at the nodes. */
static bool heights_by_formula(const Build *b, Key at, const HeightFieldScene *scene, const int cells[2],
                               double *height)
{
    at = key("%s.formula", at.text);
    Formula *formula = build_formula(b, at, &scene->formula, 1, scene->where, scene->where_count,
                                     (const char *const[]){"x", "y", NULL});
    bool ok = formula != NULL;
    for (int i = 0; ok && i <= cells[0]; i++)
        for (int j = 0; ok && j <= cells[1]; j++) {
            const double(*range)[2] = (const double(*)[2])scene->range;
            double x[2] = {range[0][0] + (range[1][0] - range[0][0]) * i / cells[0],
                           range[0][1] + (range[1][1] - range[0][1]) * j / cells[1]};
            Error err;
            ok = formula_eval(formula, x, height++, &err) || yaml_refuse(b->file, at.text, "%s", err.text);
        }
    formula_destroy(formula);
    return ok;
}

/* Row 0 of the image lies at +y. */
static void heights_of_image(const Image *image, double white, const int cells[2], double *height)
{
    for (int i = 0; i <= cells[0]; i++)
        for (int j = 0; j <= cells[1]; j++)
            *height++ = white * image_sample(image, (double)i / cells[0], 1 - (double)j / cells[1]);
}

/* Its lower corner is below its upper one. */
static bool check_range(const Build *b, Key at, const double *low, const double *high, int count)
{
    for (int i = 0; i < count; i++)
        if (!(low[i] < high[i]))
            return yaml_refuse(b->file, key("%s.range", at.text).text,
                               "its first corner must be below its second, but %c is %g and %g", "xy"[i],
                               low[i], high[i]);
    return true;
}

static bool height_field(const Build *b, Key at, const HeightFieldScene *scene, Obstacle *obstacle)
{
    enum { CELLS = 64, CELLS_MAX = 4096 };
    Image image = {0};
    Error err;
    if (!check_range(b, at, scene->range[0], scene->range[1], 2)) return false;
    if (scene->image && isnan(scene->height))
        return yaml_refuse(b->file, at.text, "an image needs `height`, where it is white, e.g. height: 5 mm");
    if (scene->image && !image_read(scene->image, &image, &err))
        return yaml_refuse(b->file, key("%s.image", at.text).text, "%s", err.text);
    int cells[2] = {CELLS, CELLS}, pixels[2] = {image.width, image.height};
    for (int i = 0; i < 2; i++) {
        if (scene->image) cells[i] = (int)fmin(fmax(pixels[i], 2), CELLS_MAX);
        if (scene->cells[0] != YAML_ABSENT) cells[i] = scene->cells[i];
    }
    double *height = mem_alloc((size_t)(cells[0] + 1) * (size_t)(cells[1] + 1), sizeof *height);
    bool ok = true;
    if (scene->image)
        heights_of_image(&image, scene->height, cells, height);
    else
        ok = heights_by_formula(b, at, scene, cells, height);
    if (ok) *obstacle = obstacle_height_field((const double(*)[2])scene->range, cells, height);
    mem_free(height);
    image_clear(&image);
    return ok;
}

/* ---- Tubes ---- */

/* Into the first `count` columns of sample[cells + 1][3]. */
static bool sample_tube(const Build *b, Key at, const TubeScene *scene, char *const *formula, int count,
                        double *sample)
{
    Formula *made = build_formula(b, at, formula, count, NULL, 0, (const char *const[]){"s", NULL});
    bool ok = made != NULL;
    for (int k = 0; ok && k <= scene->cells; k++) {
        double s = scene->range[0] + (scene->range[1] - scene->range[0]) * k / scene->cells;
        Error err;
        ok = formula_eval(made, &s, sample + 3 * k, &err) || yaml_refuse(b->file, at.text, "%s", err.text);
    }
    formula_destroy(made);
    return ok;
}

static bool tube(const Build *b, Key at, const TubeScene *scene, Obstacle *obstacle)
{
    if (!(scene->range[0] < scene->range[1]))
        return yaml_refuse(b->file, key("%s.range", at.text).text,
                           "its first number must be below its second, but they are %g and %g",
                           scene->range[0], scene->range[1]);
    double(*sample)[3] = mem_alloc((size_t)scene->cells + 1, sizeof *sample);
    Key radius = key("%s.radius", at.text);
    Error err;
    bool ok =
        sample_tube(b, radius, scene, &scene->radius, 1, sample[0]) &&
        sample_tube(b, key("%s.center", at.text), scene, scene->center, 2, sample[0] + 1) &&
        (obstacle_tube(scene->axis, scene->range, scene->cells, (const double(*)[3])sample, obstacle, &err) ||
         yaml_refuse(b->file, radius.text, "%s", err.text));
    mem_free(sample);
    return ok;
}

/* ---- Meshes ---- */

static bool solid(const Build *b, Key at, const BlockScene *scene, Obstacle *obstacle)
{
    MeshFile file = {0};
    Error err;
    bool ok = build_read_mesh(scene->file, scene->scale, &file, &err) &&
              mesh_file_check_triangles(&file, &err) && obstacle_mesh(&file, scene->cell, obstacle, &err);
    if (!ok) yaml_refuse(b->file, key("%s.file", at.text).text, "%s", err.text);
    mesh_file_clear(&file);
    return ok;
}

/* ---- All of them ---- */

static bool shape(const Build *b, Key at, const ObstacleScene *scene, Obstacle *obstacle)
{
    const SphereScene *ball = scene->sphere;
    if (scene->plane) return plane(b, key("%s.plane", at.text), scene->plane, obstacle);
    if (scene->cylinder) return cylinder(b, key("%s.cylinder", at.text), scene->cylinder, obstacle);
    if (scene->box) return box(b, key("%s.box", at.text), scene->box, obstacle);
    if (scene->height_field)
        return height_field(b, key("%s.height_field", at.text), scene->height_field, obstacle);
    if (scene->tube) return tube(b, key("%s.tube", at.text), scene->tube, obstacle);
    if (scene->mesh) return solid(b, key("%s.mesh", at.text), scene->mesh, obstacle);
    *obstacle = obstacle_sphere(ball->center, ball->radius, ball->inside);
    return true;
}

static bool check_other_names(const Build *b, Key at, const Obstacle *list, int count)
{
    for (int k = 0; k < count; k++)
        if (!strcmp(list[k].name, list[count].name))
            return yaml_refuse(b->file, at.text, "there are two obstacles named '%s'", list[k].name);
    return true;
}

bool build_obstacles(const Build *b, const ObstacleScene *scenes, int count, Obstacle **list)
{
    *list = mem_alloc((size_t)count, sizeof **list);
    bool ok = true;
    for (int k = 0; k < count; k++) {
        Obstacle *obstacle = *list + k;
        Key at = key("obstacles[%d]", k);
        ok = shape(b, at, &scenes[k], obstacle) && ok;
        obstacle->name = scenes[k].name ? mem_text(scenes[k].name) : mem_format("obstacle%d", k + 1);
        ok = build_check_name(b, at, "an obstacle", obstacle->name) && ok;
        ok = check_other_names(b, at, *list, k) && ok;
        ok = build_rigid_move(b, at, scenes[k].move, scenes[k].turn, &obstacle->motion) && ok;
    }
    return ok;
}
