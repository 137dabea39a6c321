#include "view/curves_view.h"
#include "base/memory.h"
#include "view/page.h"
#include "view/ticks.h"
#include <math.h>
#include <stdio.h>

static const Color grid = {0.91, 0.91, 0.92, 1}, edge = {0.72, 0.72, 0.74, 1};

static const double LEFT = 36, ABOVE = 16, BELOW = 28, MEASURES = 34;
static const double TICK_SPACING = 34; /* pt, at least */
static const double TOLERANCE = 0.06;  /* pt by which a drawn line may leave its points out */
static const double THIN = 0.01; /* of the largest extent: an axis along which there is nothing to see */
enum { MANY = 20 };              /* curves of a set that are too close for dashes */
static const double PADDING = 0.05, NARROWEST = 0.16; /* of the largest extent */

CurvesMargins curves_view_margins(const CurvesView *view)
{
    return view->name ? (CurvesMargins){LEFT, ABOVE, BELOW} : (CurvesMargins){0, 0, MEASURES};
}

/* ---- What is seen ---- */

static void widen(double low[3], double high[3], Mat3 directions, const double *point)
{
    double at[3];
    vec3_store(at, mat3_times(directions, vec3_load(point)));
    for (int k = 0; k < 3 && isfinite(at[0] + at[1] + at[2]); k++) {
        low[k] = fmin(low[k], at[k]);
        high[k] = fmax(high[k], at[k]);
    }
}

static void widen_by_holds(double low[3], double high[3], Mat3 directions, const Holds *holds)
{
    for (int k = 0; k < holds->count; k++)
        for (int i = 0; i < holds->items[k].way_count; i++)
            widen(low, high, directions, holds->items[k].way[i]);
}

/* Bounds of all points along three directions; false where there is none. */
static bool bounds(const CurvesScene *scene, Mat3 directions, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (int s = 0; s < scene->set_count; s++) {
        const CurvesSet *set = &scene->sets[s];
        for (int i = set->offsets[0]; i < set->offsets[set->curve_count]; i++)
            widen(low, high, directions, set->points[i]);
        for (int i = 0; i < set->around.near_count; i++) widen(low, high, directions, set->around.near[i]);
        for (int k = 0; k < set->marks.line_count; k++)
            for (int i = 0; i < set->marks.lines[k].count; i++)
                widen(low, high, directions, set->marks.lines[k].points[i]);
        for (int k = 0; k < set->marks.dot_count; k++) widen(low, high, directions, set->marks.dots[k].at);
        widen_by_holds(low, high, directions, &set->holds);
    }
    return low[0] <= high[0];
}

/* A little room around what is seen, also where that is only a line. */
static void pad(CurvesView *view, double largest)
{
    for (int k = 0; k < 2; k++) {
        double middle = 0.5 * (view->low[k] + view->high[k]), extent = view->high[k] - view->low[k];
        double half = 0.5 * fmax(extent + 2 * PADDING * largest, NARROWEST * largest);
        view->low[k] = middle - half;
        view->high[k] = middle + half;
    }
}

static int one_view(const CurvesScene *scene, CurvesView *view)
{
    double low[3], high[3], largest = 0;
    *view = (CurvesView){.camera = camera_view(vec3_load(scene->view), vec3(0, 0, 1))};
    if (!bounds(scene, (Mat3){view->camera.right, view->camera.up, view->camera.toward}, low, high)) return 0;
    for (int k = 0; k < 2; k++) {
        view->low[k] = low[k], view->high[k] = high[k];
        largest = fmax(largest, high[k] - low[k]);
    }
    pad(view, largest > 0 ? largest : 1);
    return 1;
}

int curves_views(const CurvesScene *scene, CurvesView views[CURVES_VIEWS_MAX])
{
    static const struct {
        const char *name;
        Vec3 from;
        int right, upwards;
    } sides[CURVES_VIEWS_MAX] = {
        {"front", {0, -1, 0}, 0, 2}, {"side", {1, 0, 0}, 1, 2}, {"top", {0, 0, 1}, 0, 1}};
    static const char *const axes[] = {"x", "y", "z"};
    if (vec3_length(vec3_load(scene->view)) > 0) return one_view(scene, &views[0]);
    double low[3], high[3], largest = 0, farthest = 0;
    if (!bounds(scene, mat3_identity(), low, high)) return 0;
    for (int k = 0; k < 3; k++) {
        largest = fmax(largest, high[k] - low[k]);
        farthest = fmax(farthest, fmax(fabs(low[k]), fabs(high[k])));
    }
    bool thick[3];
    int thick_count = 0, count = 0;
    for (int k = 0; k < 3; k++) thick_count += thick[k] = high[k] - low[k] > THIN * largest;
    for (int v = 0; v < CURVES_VIEWS_MAX; v++) {
        int r = sides[v].right, u = sides[v].upwards;
        bool plane = thick[r] && thick[u], line = thick_count < 2 && count == 0;
        if (!plane && !(line && (thick[r] || thick[u] || thick_count == 0))) continue;
        views[count] = (CurvesView){.name = sides[v].name,
                                    .right = axes[r],
                                    .upwards = axes[u],
                                    .camera = camera_view(sides[v].from, vec3(0, 0, 1)),
                                    .low = {low[r], low[u]},
                                    .high = {high[r], high[u]},
                                    .unit = unit_scale("m", farthest)};
        pad(&views[count++], largest > 0 ? largest : 1);
    }
    return count;
}

/* ---- Curves ---- */

static Vec2 place(const CurvesView *view, const double *point)
{
    Vec3 p = vec3_load(point);
    return (Vec2){view->box.x + view->scale * (vec3_dot(p, view->camera.right) - view->low[0]),
                  view->box.y + view->scale * (view->high[1] - vec3_dot(p, view->camera.up))};
}

Pen curves_pen(const CurvesSet *set)
{
    Pen pen = {set->color, set->width, set->curve_count > MANY ? 0 : set->dash};
    double many = fmax(set->curve_count, 1);
    pen.width = fmax(set->width * pow(many, -0.3), fmin(set->width, 0.2));
    pen.color.a *= fmax(pow(many, -0.2), 0.2);
    return pen;
}

static double distance_to_chord(Vec2 p, Vec2 a, Vec2 b)
{
    double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    double t = square > 0 ? fmin(fmax(((p.x - a.x) * x + (p.y - a.y) * y) / square, 0), 1) : 0;
    return hypot(p.x - a.x - t * x, p.y - a.y - t * y);
}

/* Leaves points out that lie within the tolerance of the line through the others; returns how many stay.
 * stack: room for as many numbers as points. [Douglas and Peucker 1973] */
static int simplify(Vec2 *points, int count, int *stack)
{
    int top = 0, first = 0, kept = 0;
    if (count < 3) return count;
    stack[top++] = count - 1;
    points[kept++] = points[0];
    while (top > 0) {
        int last = stack[top - 1], far = first;
        double farthest = TOLERANCE;
        Vec2 start = points[kept - 1];
        for (int i = first + 1; i < last; i++) {
            double distance = distance_to_chord(points[i], start, points[last]);
            if (distance > farthest) farthest = distance, far = i;
        }
        if (far > first) {
            stack[top++] = far;
            continue;
        }
        first = last, top--;
        points[kept++] = points[last];
    }
    return kept;
}

/* Runs of points that can be seen become one line each. */
static void draw_set(Canvas *canvas, const CurvesView *view, const CurvesSet *set)
{
    int longest = 0;
    for (int c = 0; c < set->curve_count; c++)
        longest = (int)fmax(longest, set->offsets[c + 1] - set->offsets[c]);
    Vec2 *line = mem_alloc((size_t)longest, sizeof *line);
    int *stack = mem_alloc((size_t)longest, sizeof *stack);
    Pen pen = curves_pen(set);
    for (int c = 0; c < set->curve_count; c++)
        for (int i = set->offsets[c], run = 0; i < set->offsets[c + 1]; i++) {
            Vec2 at = place(view, set->points[i]);
            bool seen = isfinite(at.x + at.y);
            if (seen) line[run++] = at;
            if (seen && i + 1 < set->offsets[c + 1]) continue;
            if (run > 0) canvas_polyline(canvas, line, simplify(line, run, stack), pen);
            run = 0;
        }
    mem_free(line);
    mem_free(stack);
}

static void draw_clamps(Canvas *canvas, const CurvesScene *scene, const CurvesView *view)
{
    int count = scene->clamp_count > 2 ? scene->clamp_count : 1; /* a rod has two ends */
    double side = fmax(5 * pow(count, -0.35), 0.35);
    for (int k = 0; k < scene->clamp_count; k++) {
        Vec2 at = place(view, scene->clamps[k]);
        if (isfinite(at.x + at.y)) holds_draw_square(canvas, at, side);
    }
}

/* ---- Scales ---- */

/* The same step in all views, unless it does not fall into this one. */
static Ticks ticks_along(const CurvesView *view, int k, double factor)
{
    double low = factor * view->low[k], high = factor * view->high[k];
    Ticks ticks = ticks_every(factor * ticks_round_up(TICK_SPACING / view->scale), low, high);
    return ticks.count ? ticks : ticks_linear(low, high, 2);
}

static void draw_scales(Canvas *canvas, const CurvesView *view)
{
    UnitScale unit = view->unit;
    Box box = view->box;
    double bottom = box.y + box.height;
    const Pen line = {grid, 0.6, 0}, tick = {page_soft, 0.6, 0};
    TextStyle style = {.color = page_ink, .size = PAGE_LABEL, .align = TEXT_CENTER};
    char label[96];
    Ticks ticks = ticks_along(view, 0, unit.factor);
    for (int i = 0; i < ticks.count; i++) {
        double x = box.x + view->scale * (ticks.value[i] / unit.factor - view->low[0]);
        canvas_line(canvas, (Vec2){x, box.y}, (Vec2){x, bottom}, line);
        canvas_line(canvas, (Vec2){x, bottom}, (Vec2){x, bottom + 2.5}, tick);
        canvas_text(canvas, (Vec2){x, bottom + 4 + PAGE_LABEL}, ticks.text[i], style);
    }
    snprintf(label, sizeof label, "%s (%s)", view->right, unit.unit);
    canvas_text(canvas, (Vec2){box.x + 0.5 * box.width, bottom + 6 + 2.2 * PAGE_LABEL}, label, style);
    ticks = ticks_along(view, 1, unit.factor);
    double widest = 0;
    style.align = TEXT_RIGHT;
    for (int i = 0; i < ticks.count; i++) {
        double y = box.y + view->scale * (view->high[1] - ticks.value[i] / unit.factor);
        canvas_line(canvas, (Vec2){box.x, y}, (Vec2){box.x + box.width, y}, line);
        canvas_line(canvas, (Vec2){box.x - 2.5, y}, (Vec2){box.x, y}, tick);
        canvas_text(canvas, (Vec2){box.x - 4, y + 0.36 * PAGE_LABEL}, ticks.text[i], style);
        widest = fmax(widest, canvas_text_width(canvas, ticks.text[i], style));
    }
    snprintf(label, sizeof label, "%s (%s)", view->upwards, unit.unit);
    style.align = TEXT_CENTER, style.upwards = true;
    canvas_text(canvas, (Vec2){box.x - 8 - widest, box.y + 0.5 * box.height}, label, style);
    canvas_frame(canvas, box, (Pen){edge, 0.6, 0});
}

/* Below a view from anywhere. */
static void draw_measures(Canvas *canvas, const CurvesScene *scene, const CurvesView *view)
{
    double y = view->box.y + view->box.height + MEASURES - 16;
    page_draw_axes(canvas, &view->camera, (Vec2){view->box.x + 20, y});
    if (vec3_length(vec3_load(scene->gravity)) > 0)
        page_draw_gravity(canvas, &view->camera, scene->gravity, (Vec2){view->box.x + 64, y});
    page_draw_length(canvas, view->scale, (Vec2){view->box.x + view->box.width, y});
}

/* ---- Obstacles ---- */

static bool is_shown(const CurvesSet *set, int index, int only)
{
    return !set->moment || only < 0 || index == only;
}

const Marks *curves_marks(const CurvesScene *scene, int only)
{
    const Marks *marks = NULL;
    for (int s = 0; s < scene->set_count; s++)
        if (scene->sets[s].marks.line_count + scene->sets[s].marks.dot_count > 0 &&
            is_shown(&scene->sets[s], s, only))
            marks = &scene->sets[s].marks;
    return marks;
}

const Holds *curves_holds(const CurvesScene *scene, int only)
{
    const Holds *holds = NULL;
    for (int s = 0; s < scene->set_count; s++)
        if (scene->sets[s].holds.count && is_shown(&scene->sets[s], s, only)) holds = &scene->sets[s].holds;
    return holds;
}

static const RasterMesh *obstacles_of(const CurvesScene *scene, int only)
{
    const RasterMesh *obstacles = NULL;
    for (int s = 0; s < scene->set_count; s++)
        if (scene->sets[s].around.obstacles && is_shown(&scene->sets[s], s, only))
            obstacles = scene->sets[s].around.obstacles;
    return obstacles;
}

/* Its pixels begin at the box's corner. */
static Camera camera_of(const CurvesView *view, double resolution)
{
    Camera camera = view->camera;
    camera.center = vec3(0, 0, 0), camera.distance = 0;
    camera.scale = resolution * view->scale;
    camera.x = -camera.scale * view->low[0], camera.y = camera.scale * view->high[1];
    return camera;
}

static void draw_obstacles(Canvas *canvas, const RasterMesh *obstacles, const CurvesView *view)
{
    Box box = view->box;
    double resolution = canvas_resolution(canvas);
    int width = (int)lround(resolution * box.width), height = (int)lround(resolution * box.height);
    if (width < 1 || height < 1) return;
    Camera camera = camera_of(view, resolution);
    Raster *raster = raster_create(width, height);
    unsigned char *rgba = mem_alloc(4 * (size_t)width * (size_t)height, 1);
    raster_mesh(raster, &camera, obstacles);
    raster_resolve(raster, rgba);
    canvas_image(canvas, rgba, width, height, box);
    mem_free(rgba);
    raster_destroy(raster);
}

void curves_view_draw(Canvas *canvas, const CurvesScene *scene, const CurvesView *view, int only)
{
    Box box = view->box;
    if (view->name) {
        draw_scales(canvas, view);
        canvas_text(canvas, (Vec2){box.x, box.y - 5}, view->name,
                    (TextStyle){.color = page_ink, .size = 9, .bold = true});
        if (vec3_length(vec3_load(scene->gravity)) > 0)
            page_draw_gravity(canvas, &view->camera, scene->gravity,
                              (Vec2){box.x + box.width - 5, box.y - 8});
    } else
        draw_measures(canvas, scene, view);
    const RasterMesh *obstacles = obstacles_of(scene, only);
    canvas_clip(canvas, box);
    if (obstacles) draw_obstacles(canvas, obstacles, view);
    for (int s = 0; s < scene->set_count; s++)
        if (is_shown(&scene->sets[s], s, only)) draw_set(canvas, view, &scene->sets[s]);
    const Marks *marks = curves_marks(scene, only);
    Camera camera = camera_of(view, 1);
    if (marks) marks_draw(canvas, marks, &camera, 1, (Vec2){box.x, box.y});
    draw_clamps(canvas, scene, view);
    for (int s = 0; s < scene->set_count; s++)
        if (is_shown(&scene->sets[s], s, only))
            holds_draw(canvas, &scene->sets[s].holds, &camera, (Vec2){box.x, box.y});
    canvas_unclip(canvas);
}
