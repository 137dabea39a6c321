#include "view/raster.h"
#include "base/memory.h"
#include <assert.h>
#include <math.h>
#include <stddef.h>

enum { SAMPLES = 3, MAX_SIZE = 8000, SIDES = 20, RINGS_MOST = 9, TAPS = 48 };

static const double HIDDEN_BALL = 0.5; /* of its opacity */

const Vec3 CAMERA_THREE_QUARTER = {0.45, -0.75, 0.55};

typedef struct Sample {
    unsigned char rgba[4]; /* colours multiplied by alpha */
    float depth;
} Sample;

struct Raster {
    int width, height; /* samples */
    Sample *samples;
};

/* How one face is painted. */
typedef struct Paint {
    Color fill, edge;
    double edge_width; /* samples, on this face's side */
    double hidden;
} Paint;

Camera camera_view(Vec3 from, Vec3 up)
{
    Camera camera = {.toward = vec3_unit(from), .scale = 1};
    const Vec3 tries[] = {up, {0, 0, 1}, {0, 1, 0}};
    for (int i = 0; i < 3; i++) {
        Vec3 right = vec3_cross(tries[i], camera.toward);
        if (!(vec3_length(right) > 1e-6 * vec3_length(tries[i]))) continue;
        camera.right = vec3_unit(right);
        break;
    }
    camera.up = vec3_cross(camera.toward, camera.right);
    return camera;
}

Vec3 camera_project(const Camera *camera, Vec3 point)
{
    Vec3 d = vec3_sub(point, camera->center);
    double height = vec3_dot(d, camera->toward), zoom = 1;
    if (camera->distance > 0) zoom = height < camera->distance ? 1 / (1 - height / camera->distance) : NAN;
    return vec3(camera->x + camera->scale * zoom * vec3_dot(d, camera->right),
                camera->y - camera->scale * zoom * vec3_dot(d, camera->up), zoom * height);
}

bool camera_bounds(const Camera *camera, const double (*points)[3], int count, Vec3 *low, Vec3 *high)
{
    *low = vec3(INFINITY, INFINITY, INFINITY);
    *high = vec3(-INFINITY, -INFINITY, -INFINITY);
    for (int i = 0; i < count; i++) {
        Vec3 p = camera_project(camera, vec3_load(points[i]));
        if (!isfinite(p.x + p.y + p.z)) continue;
        *low = vec3(fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z));
        *high = vec3(fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z));
    }
    return low->x <= high->x;
}

void camera_fit(Camera *camera, const double (*points)[3], int count, double width, double height,
                double margin, double perspective)
{
    Vec3 low, high;
    camera->center = vec3(0, 0, 0);
    camera->x = camera->y = camera->distance = 0;
    camera->scale = 1;
    if (camera_bounds(camera, points, count, &low, &high)) {
        Vec3 middle = vec3_scale(0.5, vec3_add(low, high)); /* in the camera's frame, y down */
        camera->center = vec3_axpy(middle.x, camera->right, vec3_scale(-middle.y, camera->up));
        camera->center = vec3_axpy(middle.z, camera->toward, camera->center);
        camera->distance = perspective * 0.5 * vec3_length(vec3_sub(high, low));
        camera_bounds(camera, points, count, &low, &high);
        double wide = high.x - low.x, tall = high.y - low.y;
        double scale = fmin((width - 2 * margin) / wide, (height - 2 * margin) / tall);
        if (isfinite(scale) && scale > 0) camera->scale = scale;
        camera->x = -0.5 * camera->scale * (low.x + high.x);
        camera->y = -0.5 * camera->scale * (low.y + high.y);
    }
    camera->x += 0.5 * width;
    camera->y += 0.5 * height;
}

Raster *raster_create(int width, int height)
{
    assert(width >= 1 && height >= 1 && width <= MAX_SIZE && height <= MAX_SIZE);
    Raster *raster = mem_alloc(1, sizeof *raster);
    raster->width = SAMPLES * width;
    raster->height = SAMPLES * height;
    size_t count = (size_t)raster->width * (size_t)raster->height;
    raster->samples = mem_alloc(count, sizeof *raster->samples);
    for (size_t i = 0; i < count; i++) raster->samples[i].depth = -INFINITY;
    return raster;
}

void raster_destroy(Raster *raster)
{
    if (!raster) return;
    mem_free(raster->samples);
    mem_free(raster);
}

/* sample = color over sample */
static void sample_blend(Sample *sample, Color color, double alpha)
{
    const double rgba[4] = {color.r, color.g, color.b, 1};
    for (int c = 0; c < 4; c++)
        sample->rgba[c] = (unsigned char)lround(255 * alpha * rgba[c] + (1 - alpha) * sample->rgba[c]);
}

static void sample_paint(Sample *sample, Color color, double depth, double hidden)
{
    if (color.a <= 0) return;
    bool front = depth > sample->depth;
    if (front) sample->depth = (float)depth;
    double alpha = front ? color.a : color.a * hidden;
    if (alpha > 0) sample_blend(sample, color, alpha);
}

/* Twice the area of a, b, p. The same number with the other sign for b, a, p, to the last bit: neighbouring
 * faces share out the samples on their common edge without gap or overlap. */
static double edge_function(Vec3 a, Vec3 b, double x, double y)
{
    bool swap = b.x < a.x || (b.x == a.x && b.y < a.y);
    Vec3 from = swap ? b : a, to = swap ? a : b;
    double area = (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
    return swap ? -area : area;
}

/* Does a sample exactly on this edge belong to the face on its positive side? True for one of the two
 * directions. */
static bool edge_owns(Vec3 a, Vec3 b)
{
    return b.y < a.y || (b.y == a.y && b.x < a.x);
}

/* Are the samples of a row from `left` to before `right` all beyond one edge? An edge function, as it is rounded, rises or
 * falls all along a row: what is so at both ends is so between. Faces of what is a million times larger than the picture
 * would take minutes otherwise. */
static bool row_misses(const Vec3 p[3], int left, int right, double y)
{
    for (int k = 0; k < 3; k++) {
        Vec3 a = p[(k + 1) % 3], b = p[(k + 2) % 3];
        if (edge_function(a, b, left + 0.5, y) < 0 && edge_function(a, b, right - 0.5, y) < 0) return true;
    }
    return false;
}

/* Of what may be beyond all integers. */
static int clip(double value, int size)
{
    return (int)fmin(fmax(value, 0), size);
}

/* p in samples, with depth in z */
static void triangle_paint(Raster *raster, Vec3 p[3], const Paint *paint)
{
    double area = edge_function(p[0], p[1], p[2].x, p[2].y);
    if (!(fabs(area) > 0) || !isfinite(area)) return;
    if (area < 0) {
        Vec3 swap = p[1];
        p[1] = p[2];
        p[2] = swap;
        area = -area;
    }
    double length[3];
    bool owns[3];
    for (int k = 0; k < 3; k++) { /* edge k is opposite to vertex k */
        Vec3 a = p[(k + 1) % 3], b = p[(k + 2) % 3];
        length[k] = hypot(b.x - a.x, b.y - a.y);
        owns[k] = edge_owns(a, b);
    }
    double x[2] = {fmin(p[0].x, fmin(p[1].x, p[2].x)), fmax(p[0].x, fmax(p[1].x, p[2].x))},
           y[2] = {fmin(p[0].y, fmin(p[1].y, p[2].y)), fmax(p[0].y, fmax(p[1].y, p[2].y))};
    int left = clip(floor(x[0]), raster->width), right = clip(ceil(x[1]), raster->width),
        top = clip(floor(y[0]), raster->height), bottom = clip(ceil(y[1]), raster->height);
    for (int i = top; i < bottom; i++)
        for (int j = row_misses(p, left, right, i + 0.5) ? right : left; j < right; j++) {
            double depth = 0, nearest = INFINITY;
            bool inside = true;
            for (int k = 0; k < 3 && inside; k++) {
                double e = edge_function(p[(k + 1) % 3], p[(k + 2) % 3], j + 0.5, i + 0.5);
                inside = e > 0 || (e == 0 && owns[k]);
                depth += e / area * p[k].z;
                nearest = fmin(nearest, e / length[k]);
            }
            if (!inside) continue;
            Sample *sample = &raster->samples[(size_t)i * (size_t)raster->width + (size_t)j];
            sample_paint(sample, paint->fill, depth, paint->hidden);
            if (nearest < paint->edge_width) /* not hidden by its own fill, which has the same depth */
                sample_paint(sample, paint->edge,
                             paint->fill.a > 0 ? nextafterf((float)depth, INFINITY) : depth, paint->hidden);
        }
}

/* A headlight, and a key light over the viewer's left shoulder; a face towards the eye keeps about its
 * colour. */
static Color face_shade(const Camera *camera, const Vec3 v[3], Color color)
{
    Vec3 normal = vec3_cross(vec3_sub(v[1], v[0]), vec3_sub(v[2], v[0]));
    if (!(vec3_length(normal) > 0)) return color;
    normal = vec3_unit(normal);
    if (vec3_dot(normal, camera->toward) < 0) normal = vec3_scale(-1, normal);
    Vec3 key = vec3_axpy(-0.6, camera->right, vec3_axpy(0.8, camera->up, camera->toward));
    double light =
        0.45 + 0.32 * vec3_dot(normal, camera->toward) + 0.28 * fmax(0, vec3_dot(normal, vec3_unit(key)));
    return (Color){fmin(1, light * color.r), fmin(1, light * color.g), fmin(1, light * color.b), color.a};
}

/* A face that is seen edge-on, by its longest side. */
static void line_paint(Raster *raster, const Vec3 p[3], Color color, double width)
{
    Vec3 from = p[0], to = p[0];
    for (int k = 0; k < 3; k++) {
        Vec3 a = p[k], b = p[(k + 1) % 3];
        if (hypot(b.x - a.x, b.y - a.y) > hypot(to.x - from.x, to.y - from.y)) from = a, to = b;
    }
    double length = hypot(to.x - from.x, to.y - from.y);
    Vec3 across = vec3(-0.5 * width * (to.y - from.y) / length, 0.5 * width * (to.x - from.x) / length, 0);
    Vec3 quad[2][3] = {{vec3_add(from, across), vec3_sub(from, across), vec3_sub(to, across)},
                       {vec3_add(from, across), vec3_sub(to, across), vec3_add(to, across)}};
    for (int t = 0; t < 2 && length > 0; t++) triangle_paint(raster, quad[t], &(Paint){.fill = color});
}

/* Has it to be left to triangle_paint, with its face? */
static bool one_side_paint(Raster *raster, const RasterMesh *mesh, const Vec3 p[3])
{
    const double THIN = 1e-6; /* of the square of its longest side */
    double area = edge_function(p[0], p[1], p[2].x, p[2].y), square = 0;
    for (int k = 0; k < 3; k++) {
        Vec3 d = vec3_sub(p[(k + 1) % 3], p[k]);
        square = fmax(square, d.x * d.x + d.y * d.y);
    }
    if (fabs(area) > THIN * square) return area < 0; /* y points down */
    line_paint(raster, p, mesh->edge_color, SAMPLES * mesh->edge_width);
    return false;
}

void raster_mesh(Raster *raster, const Camera *camera, const RasterMesh *mesh)
{
    for (int f = 0; f < mesh->face_count; f++) {
        Vec3 world[3], seen[3];
        bool whole = true;
        for (int k = 0; k < 3; k++) {
            world[k] = vec3_load(mesh->vertices[mesh->faces[f][k]]);
            Vec3 p = camera_project(camera, world[k]);
            seen[k] = vec3(SAMPLES * p.x, SAMPLES * p.y, p.z + mesh->raise);
            whole = whole && isfinite(seen[k].x + seen[k].y + seen[k].z);
        }
        if (!whole || (mesh->one_sided && !one_side_paint(raster, mesh, seen))) continue;
        Color color = mesh->face_colors ? mesh->face_colors[f] : mesh->color;
        Paint paint = {.fill = face_shade(camera, world, color),
                       .edge = mesh->edge_color,
                       .edge_width = mesh->one_sided ? 0 : 0.5 * SAMPLES * mesh->edge_width,
                       .hidden = mesh->hidden};
        triangle_paint(raster, seen, &paint);
    }
}

/* A surface round an axis from `middle` on: rings of vertices, how far along the axis and across it each. */
static void paint_round(Raster *raster, const Camera *camera, const Camera *axis, Vec3 middle,
                        const double (*rings)[2], int ring_count, RasterMesh mesh)
{
    double vertices[RINGS_MOST * SIDES][3];
    int faces[(RINGS_MOST - 1) * SIDES * 2][3], face_count = 0;
    for (int r = 0; r < ring_count; r++)
        for (int s = 0; s < SIDES; s++) {
            double angle = 2 * acos(-1) * s / SIDES;
            Vec3 v = vec3_axpy(rings[r][0], axis->toward, middle);
            v = vec3_axpy(rings[r][1] * cos(angle), axis->right, v);
            vec3_store(vertices[r * SIDES + s], vec3_axpy(rings[r][1] * sin(angle), axis->up, v));
        }
    for (int r = 0; r + 1 < ring_count; r++)
        for (int s = 0; s < SIDES; s++) {
            int a = r * SIDES + s, b = r * SIDES + (s + 1) % SIDES;
            int quad[2][3] = {{a, b, b + SIDES}, {a, b + SIDES, a + SIDES}};
            for (int t = 0; t < 2; t++, face_count++)
                for (int k = 0; k < 3; k++) faces[face_count][k] = quad[t][k];
        }
    mesh.vertex_count = ring_count * SIDES, mesh.face_count = face_count;
    mesh.vertices = (const double(*)[3])vertices, mesh.faces = (const int(*)[3])faces;
    raster_mesh(raster, camera, &mesh);
}

/* Five rings along the axis: tail (closed), tail, neck, head's base, tip (closed). */
void raster_arrow(Raster *raster, const Camera *camera, Vec3 middle, Vec3 vector, double thickness,
                  Color color)
{
    double length = vec3_length(vector);
    if (!(length > 0)) return;
    Camera axis = camera_view(vector, camera->up); /* two directions across the axis */
    double head = fmin(2.9 * thickness, length), radius = 0.5 * thickness, end = 0.5 * length;
    const double rings[][2] = {
        {-end, 0}, {-end, radius}, {end - head, radius}, {end - head, 2.6 * radius}, {end, 0}};
    paint_round(raster, camera, &axis, middle, rings, 5,
                (RasterMesh){.color = color,
                             .raise = 0.5 * fabs(vec3_dot(vector, camera->toward)) + 1.3 * thickness});
}

void raster_ball(Raster *raster, const Camera *camera, Vec3 center, double radius, Color color)
{
    double rings[RINGS_MOST][2];
    for (int r = 0; r < RINGS_MOST; r++) {
        double angle = acos(-1) * r / (RINGS_MOST - 1);
        rings[r][0] = radius * cos(angle), rings[r][1] = radius * sin(angle);
    }
    paint_round(raster, camera, camera, center, (const double(*)[2])rings, RINGS_MOST,
                (RasterMesh){.color = color, .hidden = HIDDEN_BALL});
}

/* Depth of a sample; NaN outside and where nothing was drawn. */
static double depth_at(const Raster *raster, int i, int j)
{
    if (i < 0 || j < 0 || i >= raster->height || j >= raster->width) return NAN;
    float depth = raster->samples[(size_t)i * (size_t)raster->width + (size_t)j].depth;
    return depth > -INFINITY ? depth : NAN;
}

/* How much the surroundings of a sample rise above its face, 0..1: over the taps of a disc, the sine of the
 * angle under which each rises, less the slope seen on the opposite side, so that a tilted plane stays as it
 * is. What rises by several reaches is another thing far in front and counts little. [after Bavoil 2008] */
static double occlusion(const Raster *raster, int i, int j, const int (*taps)[2], double reach)
{
    double here = depth_at(raster, i, j), sum = 0;
    for (int k = 0; k < TAPS; k++) {
        double rise = depth_at(raster, i + taps[k][0], j + taps[k][1]) - here;
        double fall = here - depth_at(raster, i - taps[k][0], j - taps[k][1]);
        if (!(rise > 0) || isnan(fall)) continue;
        rise = (rise - fmax(fall, 0)) / reach;
        if (rise > 0) sum += rise / (sqrt(rise * rise + (k + 0.5) / TAPS) * (1 + 0.25 * rise * rise));
    }
    return sum / TAPS;
}

void raster_occlude(Raster *raster, const Camera *camera, double reach, double strength)
{
    int taps[TAPS][2];
    for (int k = 0; k < TAPS;
         k++) { /* sunflower seeds: even over the disc, the k-th at radius^2 (k + 1/2)/TAPS */
        double radius = SAMPLES * reach * camera->scale * sqrt((k + 0.5) / TAPS),
               angle = 2.399963229728653 * k;
        taps[k][0] = (int)lround(radius * sin(angle));
        taps[k][1] = (int)lround(radius * cos(angle));
    }
    for (int i = 0; i < raster->height; i += SAMPLES)
        for (int j = 0; j < raster->width; j += SAMPLES) {
            double dark = occlusion(raster, i + SAMPLES / 2, j + SAMPLES / 2, (const int(*)[2])taps, reach);
            for (int s = 0; s < SAMPLES * SAMPLES && dark > 0; s++) {
                size_t at = (size_t)(i + s / SAMPLES) * (size_t)raster->width + (size_t)(j + s % SAMPLES);
                for (int c = 0; c < 3; c++)
                    raster->samples[at].rgba[c] =
                        (unsigned char)lround((1 - strength * dark) * raster->samples[at].rgba[c]);
            }
        }
}

void raster_show_through(Raster *raster, const Raster *behind, double opacity)
{
    size_t count = (size_t)raster->width * (size_t)raster->height;
    for (size_t i = 0; i < count; i++) {
        const Sample *from = &behind->samples[i];
        Sample *to = &raster->samples[i];
        if (from->rgba[3] == 0 || from->depth >= to->depth) continue;
        for (int c = 0; c < 4; c++)
            to->rgba[c] = (unsigned char)lround(opacity * from->rgba[c] + (1 - opacity) * to->rgba[c]);
    }
}

void raster_resolve(const Raster *raster, unsigned char *rgba)
{
    for (int i = 0; i < raster->height; i += SAMPLES)
        for (int j = 0; j < raster->width; j += SAMPLES, rgba += 4) {
            int sum[4] = {0};
            for (int s = 0; s < SAMPLES * SAMPLES; s++) {
                size_t at = (size_t)(i + s / SAMPLES) * (size_t)raster->width + (size_t)(j + s % SAMPLES);
                for (int c = 0; c < 4; c++) sum[c] += raster->samples[at].rgba[c];
            }
            const int count = SAMPLES * SAMPLES;
            for (int c = 0; c < 3; c++)
                rgba[c] = (unsigned char)(sum[3] ? fmin(255, (255.0 * sum[c]) / sum[3] + 0.5) : 0);
            rgba[3] = (unsigned char)((sum[3] + count / 2) / count);
        }
}
