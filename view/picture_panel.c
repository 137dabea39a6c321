#include "view/picture_panel.h"
#include "base/memory.h"
#include "view/page.h"
#include "view/picture_target.h"
#include "view/ticks.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double ARROW_SPACING = 24; /* points */
static const double THROUGH = 0.35;     /* of a body behind an obstacle shines through */
enum { ARROWS_LEAST = 12, ARROWS_MOST = 250 };

static const Color plain = {0.8, 0.82, 0.85, 1};
const Color panel_target_ink = {0.835, 0.369, 0, 1};
static const Color vector_ink = {0.86, 0.2, 0.14, 1}, field_ink = {0, 0.447, 0.698, 1};

bool panel_any_field(const PictureScene *scene)
{
    bool any = false;
    for (int i = 0; i < scene->panel_count; i++) any = any || scene->panels[i].field;
    return any;
}

bool panel_any_vectors(const PictureScene *scene)
{
    bool any = false;
    for (int i = 0; i < scene->panel_count; i++) any = any || scene->panels[i].vectors;
    return any;
}

/* Points that a camera has to show. */
typedef struct Shown {
    double (*points)[3]; /* owned */
    int count;
} Shown;

static void show_points(Shown *shown, const double (*points)[3], int count)
{
    size_t old = (size_t)shown->count, more = (size_t)count;
    if (!points) return;
    shown->points = mem_resize(shown->points, old, old + more, sizeof *points);
    memcpy(shown->points + old, points, more * sizeof *points);
    shown->count += count;
}

/* The panel's result, target and what else is to be seen, one after the other. */
static void show_panel(Shown *shown, const PictureScene *scene, const PicturePanel *panel)
{
    show_points(shown, panel->x, scene->vertex_count);
    show_points(shown, panel->target, scene->vertex_count);
    show_points(shown, panel->around.near, panel->around.near_count);
    for (int k = 0; k < panel->marks.line_count; k++)
        show_points(shown, panel->marks.lines[k].points, panel->marks.lines[k].count);
    for (int k = 0; k < panel->marks.dot_count; k++)
        show_points(shown, (const double(*)[3])panel->marks.dots[k].at, 1);
}

/* Pixels beside the body, where obstacles are: what it stands on is seen. */
static double room_around(const PictureScene *scene, double width)
{
    for (int i = 0; i < scene->panel_count; i++)
        if (scene->panels[i].around.obstacles) return 0.06 * width;
    return 0;
}

/* Pixels; 0 where nothing is seen. */
static double seen_height(const Camera *camera, const Shown *shown, double around)
{
    Vec3 low, high;
    bool seen = camera_bounds(camera, (const double(*)[3])shown->points, shown->count, &low, &high);
    return seen ? high.y - low.y + 2 * around : 0;
}

/* One camera that has room for all panels, each at its place. */
static void fit_one_camera(PanelStyle *style, Camera view, double width, double height)
{
    const PictureScene *scene = style->scene;
    Shown shown = {0};
    for (int i = 0; i < scene->panel_count; i++) show_panel(&shown, scene, &scene->panels[i]);
    double around = room_around(scene, width);
    camera_fit(&view, (const double(*)[3])shown.points, shown.count, width, height, around,
               scene->perspective);
    view.x -= 0.5 * width, view.y -= 0.5 * height;
    style->scale = view.scale;
    double tall = seen_height(&view, &shown, around);
    for (int i = 0; i < scene->panel_count; i++) {
        style->cameras[i] = view;
        style->heights[i] = tall / style->resolution;
    }
    mem_free(shown.points);
}

/* Fits each panel by itself, takes the least scale for all, and measures the heights that this gives. */
static void fit_cameras(PanelStyle *style, double width, double height)
{
    const PictureScene *scene = style->scene;
    Vec3 from = vec3_load(scene->view);
    if (!(vec3_length(from) > 0)) from = CAMERA_THREE_QUARTER;
    Camera view = camera_view(from, vec3_load(scene->up));
    if (scene->same_view) {
        fit_one_camera(style, view, width, height);
        return;
    }
    double around = room_around(scene, width);
    style->scale = INFINITY;
    for (int i = 0; i < scene->panel_count; i++) {
        Shown shown = {0};
        show_panel(&shown, scene, &scene->panels[i]);
        style->cameras[i] = view;
        camera_fit(&style->cameras[i], (const double(*)[3])shown.points, shown.count, width, height, around,
                   scene->perspective);
        style->scale = fmin(style->scale, style->cameras[i].scale);
        mem_free(shown.points);
    }
    for (int i = 0; i < scene->panel_count; i++) {
        Camera *camera = &style->cameras[i];
        camera->x = (camera->x - 0.5 * width) * style->scale / camera->scale;
        camera->y = (camera->y - 0.5 * height) * style->scale / camera->scale;
        camera->scale = style->scale;
        Shown shown = {0};
        show_panel(&shown, scene, &scene->panels[i]);
        style->heights[i] = seen_height(camera, &shown, around) / style->resolution;
        mem_free(shown.points);
    }
}

static ColorScale scene_color_scale(const PictureScene *scene)
{
    double low = scene->field_low, high = scene->field_high;
    if (low < high) return (ColorScale){low == -high ? COLORMAP_DIVERGING : COLORMAP_VIRIDIS, low, high};
    int nf = scene->face_count, count = 0;
    double *values = mem_alloc((size_t)(scene->panel_count * nf), sizeof *values);
    for (int i = 0; i < scene->panel_count; i++) {
        if (!scene->panels[i].field) continue;
        memcpy(values + count, scene->panels[i].field, (size_t)nf * sizeof *values);
        count += nf;
    }
    ColorScale scale = color_scale_fit(values, count);
    mem_free(values);
    return scale;
}

static Vec3 face_center(const PictureScene *scene, const double (*x)[3], int f)
{
    const int *v = scene->faces[f];
    return vec3_scale(1.0 / 3,
                      vec3_add(vec3_load(x[v[0]]), vec3_add(vec3_load(x[v[1]]), vec3_load(x[v[2]]))));
}

static double faces_area(const PictureScene *scene, const double (*x)[3])
{
    double area = 0;
    for (int f = 0; f < scene->face_count; f++) {
        const int *v = scene->faces[f];
        Vec3 a = vec3_load(x[v[0]]), b = vec3_sub(vec3_load(x[v[1]]), a), c = vec3_sub(vec3_load(x[v[2]]), a);
        double twice = vec3_length(vec3_cross(b, c));
        if (isfinite(twice)) area += 0.5 * twice;
    }
    return area;
}

/* Each next face is the one farthest from all chosen ones: evenly spread, whatever the mesh. [Gonzalez 1985]
 */
static int *faces_spread(const PictureScene *scene, const double (*x)[3], int count)
{
    int nf = scene->face_count, next = 0;
    int *chosen = mem_alloc((size_t)count, sizeof *chosen);
    double *distance = mem_alloc((size_t)nf, sizeof *distance);
    for (int f = 0; f < nf; f++) { /* a face that is nowhere is never the farthest */
        Vec3 center = face_center(scene, x, f);
        distance[f] = isfinite(center.x + center.y + center.z) ? INFINITY : -1;
    }
    for (int i = 0; i < count; i++) {
        chosen[i] = next;
        Vec3 center = face_center(scene, x, next);
        for (int f = 0; f < nf; f++) {
            Vec3 d = vec3_sub(face_center(scene, x, f), center);
            distance[f] = fmin(distance[f], vec3_dot(d, d));
            if (distance[f] > distance[next]) next = f;
        }
    }
    mem_free(distance);
    return chosen;
}

static double vectors_greatest(const PictureScene *scene)
{
    double greatest = 0;
    for (int i = 0; i < scene->panel_count; i++)
        for (int f = 0; scene->panels[i].vectors && f < scene->face_count; f++)
            greatest = fmax(greatest, vec3_length(vec3_load(scene->panels[i].vectors[f])));
    return greatest;
}

static double flux_greatest(const PictureScene *scene)
{
    double greatest = 0;
    for (int i = 0; i < scene->panel_count; i++)
        if (scene->panels[i].flux_density)
            greatest = fmax(greatest, vec3_length(vec3_load(scene->panels[i].flux_density)));
    return greatest;
}

PanelStyle panel_style_create(const PictureScene *scene, double resolution, double width, double height)
{
    PanelStyle style = {.scene = scene, .resolution = resolution, .colors = scene_color_scale(scene)};
    style.cameras = mem_alloc((size_t)scene->panel_count, sizeof *style.cameras);
    style.heights = mem_alloc((size_t)scene->panel_count, sizeof *style.heights);
    fit_cameras(&style, resolution * width, resolution * height);
    style.arrow_greatest = vectors_greatest(scene);
    style.flux_greatest = scene->same_view ? flux_greatest(scene) : 0;
    if (!(style.arrow_greatest > 0)) return style;
    const double(*x)[3] = scene->panels[0].x;
    style.arrow_color =
        panel_any_field(scene) && style.colors.map == COLORMAP_DIVERGING ? page_ink : vector_ink;
    double area = faces_area(scene, x), spacing = ARROW_SPACING * resolution / style.scale;
    style.arrow_count =
        (int)fmin(fmax(area / (spacing * spacing), ARROWS_LEAST), fmin(ARROWS_MOST, scene->face_count));
    style.arrow_faces = faces_spread(scene, x, style.arrow_count);
    style.arrow_length = 1.1 * sqrt(area / style.arrow_count);
    return style;
}

void panel_style_clear(PanelStyle *style)
{
    mem_free(style->cameras);
    mem_free(style->heights);
    mem_free(style->arrow_faces);
    *style = (PanelStyle){.scene = NULL};
}

/* Edges fade out where the faces are only a few pixels wide. */
static Color edge_color(const PanelStyle *style, Color color, double opacity)
{
    const PictureScene *scene = style->scene;
    double size = sqrt(faces_area(scene, scene->panels[0].x) / fmax(1, scene->face_count)) * style->scale;
    color.a = opacity * fmin(fmax((size - 2) / 10, 0), 1);
    return color;
}

static void draw_mesh(Raster *raster, const PanelStyle *style, const Camera *camera, const double (*x)[3],
                      const Color *colors)
{
    RasterMesh mesh = {.vertex_count = style->scene->vertex_count,
                       .face_count = style->scene->face_count,
                       .vertices = x,
                       .faces = style->scene->faces,
                       .face_colors = colors,
                       .color = plain,
                       .edge_color = edge_color(style, page_ink, 0.3),
                       .edge_width = style->scene->edges ? 0.25 * style->resolution : 0};
    raster_mesh(raster, camera, &mesh);
}

static void draw_wires(Raster *raster, const PanelStyle *style, const Camera *camera, const double (*x)[3])
{
    RasterMesh mesh = {.vertex_count = style->scene->vertex_count,
                       .face_count = style->scene->face_count,
                       .vertices = x,
                       .faces = style->scene->faces,
                       .edge_color = edge_color(style, panel_target_ink, 0.9),
                       .edge_width = 0.4 * style->resolution,
                       .hidden = 0.25,
                       .raise = style->resolution / style->scale};
    raster_mesh(raster, camera, &mesh);
}

static void draw_arrows(Raster *raster, const PanelStyle *style, const Camera *camera,
                        const PicturePanel *panel)
{
    double unit = style->arrow_length / style->arrow_greatest;
    for (int i = 0; i < style->arrow_count; i++) {
        int f = style->arrow_faces[i];
        Vec3 vector = vec3_scale(unit, vec3_load(panel->vectors[f])),
             middle = face_center(style->scene, panel->x, f);
        if (!(vec3_length(vector) > 0.03 * style->arrow_length) || !isfinite(middle.x + middle.y + middle.z))
            continue;
        raster_arrow(raster, camera, middle, vector, 0.085 * style->arrow_length, style->arrow_color);
    }
}

/* Pixels of a length in points. */
static int pixels_of(const PanelStyle *style, double length)
{
    return (int)lround(length * style->resolution);
}

static Raster *raster_begin(const PanelStyle *style, int index, Box box, Camera *camera)
{
    *camera = style->cameras[index];
    camera->x += 0.5 * style->resolution * box.width;
    camera->y += 0.5 * style->resolution * box.height;
    return raster_create(pixels_of(style, box.width), pixels_of(style, box.height));
}

static void raster_crease(Raster *raster, const PanelStyle *style, const Camera *camera)
{
    raster_occlude(raster, camera, 10 * style->resolution / style->scale, 0.55);
}

/* Puts the raster on the page and frees it. */
static void raster_end(Canvas *canvas, const PanelStyle *style, Raster *raster, Box box)
{
    int width = pixels_of(style, box.width), height = pixels_of(style, box.height);
    unsigned char *rgba = mem_alloc(4 * (size_t)width * (size_t)height, 1);
    raster_resolve(raster, rgba);
    canvas_image(canvas, rgba, width, height, box);
    mem_free(rgba);
    raster_destroy(raster);
}

static void draw_body(Raster *raster, const PanelStyle *style, const Camera *camera,
                      const PicturePanel *panel, const Color *colors)
{
    draw_mesh(raster, style, camera, panel->x, colors);
    if (panel->vectors) draw_arrows(raster, style, camera, panel);
    if (!panel->target || picture_target_place(style->scene, panel) == PICTURE_TARGET_BESIDE) return;
    draw_wires(raster, style, camera, panel->target);
    picture_target_dots(raster, style, camera, panel->target);
}

void panel_draw_result(Canvas *canvas, const PanelStyle *style, int index, Box box)
{
    const PicturePanel *panel = &style->scene->panels[index];
    int nf = style->scene->face_count;
    Color *colors = panel->field ? mem_alloc((size_t)nf, sizeof *colors) : NULL;
    for (int f = 0; colors && f < nf; f++) colors[f] = color_scale_color(&style->colors, panel->field[f]);
    Camera camera;
    Raster *raster = raster_begin(style, index, box, &camera), *bare = NULL;
    draw_body(raster, style, &camera, panel, colors);
    if (panel->around.obstacles) {
        bare = raster_begin(style, index, box, &camera);
        draw_body(bare, style, &camera, panel, colors);
        raster_mesh(raster, &camera, panel->around.obstacles);
    }
    raster_crease(raster, style, &camera);
    if (bare) raster_show_through(raster, bare, THROUGH);
    raster_destroy(bare);
    raster_end(canvas, style, raster, box);
    marks_draw(canvas, &panel->marks, &camera, style->resolution, (Vec2){box.x, box.y});
    mem_free(colors);
}

void panel_draw_target(Canvas *canvas, const PanelStyle *style, int index, Box box)
{
    Camera camera;
    Raster *raster = raster_begin(style, index, box, &camera);
    const double(*target)[3] = style->scene->panels[index].target;
    draw_mesh(raster, style, &camera, target, NULL);
    picture_target_dots(raster, style, &camera, target);
    raster_crease(raster, style, &camera);
    raster_end(canvas, style, raster, box);
}

static Vec2 seen_along(const Camera *camera, Vec2 from, Vec3 direction, double length)
{
    return (Vec2){from.x + length * vec3_dot(direction, camera->right),
                  from.y - length * vec3_dot(direction, camera->up)};
}

/* An arrow of 26 points with the field's size, or one whose length goes with its root beside `greatest`. */
static void draw_flux_density(Canvas *canvas, const Camera *camera, const double *flux_density,
                              double greatest, Vec2 middle)
{
    double size = vec3_length(vec3_load(flux_density));
    if (!(size > 0)) return;
    Vec3 along = vec3_scale(1 / size, vec3_load(flux_density));
    double half = 13 * (greatest > 0 ? sqrt(size / greatest) : 1);
    Vec2 tail = seen_along(camera, middle, along, -half), tip = seen_along(camera, middle, along, half);
    canvas_arrow(canvas, tail, tip, (Pen){field_ink, 1.5, 0});
    if (greatest > 0) return; /* its size stands in the panel's heading */
    char label[96], number[80];
    unit_format(size, "T", number, sizeof number);
    snprintf(label, sizeof label, "B = %s", number);
    canvas_text(canvas, (Vec2){fmax(tail.x, tip.x) + 8, middle.y + 3}, label,
                (TextStyle){.color = field_ink, .size = 8});
}

void panel_draw_measures(Canvas *canvas, const PanelStyle *style, int index, Box box)
{
    const double *flux_density = style->scene->panels[index].flux_density,
                 *gravity = style->scene->panels[index].gravity;
    bool falls = gravity && vec3_length(vec3_load(gravity)) > 0;
    Vec2 origin = {box.x + 18, box.y + box.height - 16};
    page_draw_axes(canvas, &style->cameras[index], origin);
    if (falls)
        page_draw_gravity(canvas, &style->cameras[index], gravity, (Vec2){origin.x + 42, origin.y - 6});
    if (flux_density)
        draw_flux_density(canvas, &style->cameras[index], flux_density, style->flux_greatest,
                          (Vec2){origin.x + (falls ? 72 : 42), origin.y - 6});
    if (!(style->scene->perspective > 0)) /* in a perspective view no length holds everywhere */
        page_draw_length(canvas, style->scale / style->resolution,
                         (Vec2){box.x + box.width - 6, box.y + box.height - 10});
}
