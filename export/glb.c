#include "base/memory.h"
#include "export/body.h"
#include "export/gltf.h"
#include "view/show_obstacles.h"
#include "view/show_cases.h"
#include "view/show_curves.h"
#include <ctype.h>
#include <math.h>
#include <string.h>

static const Color plain = {0.62, 0.72, 0.84, 1}, white = {1, 1, 1, 1};

typedef struct Glb {
    ShowData *data;
    Moments moments;
    ShowCases cases;
    int times; /* accessor of them; of more than one moment */
    Gltf gltf;
} Glb;

/* ---- The body ---- */

/* "_VON_MISES": what is no attribute of glTF's own begins so. */
static char *attribute_name(ShowData *data, const char *field)
{
    char *name = show_text(data, "_%s", field);
    for (char *c = name; *c; c++) *c = isalnum((unsigned char)*c) ? (char)toupper((unsigned char)*c) : '_';
    return name;
}

/* Numbers of a target less those that the body has itself. */
static int add_difference(Glb *glb, const float (*of)[3], const float (*base)[3], int count)
{
    float *away = show_block(glb->data, 3 * (size_t)count, sizeof *away);
    for (int i = 0; i < 3 * count; i++) away[i] = of[i / 3][i % 3] - base[i / 3][i % 3];
    return gltf_vertices(&glb->gltf, away, count, 3);
}

/* The body itself is at its first moment, and has the colours of its last one: those who cannot change colours show them. */
static const float (*base_colors(const ExportBody *body))[3]
{
    return body->colors[body->color_count - 1];
}

/* The first moment that is a target: with colours that change also that of the body itself. */
static int first_target(const ExportBody *body)
{
    return body->color_count > 1 ? 0 : 1;
}

/* The moments, and what viewers call them. */
static void add_targets(Glb *glb, const ExportBody *body, Text *names)
{
    Text *text = &glb->gltf.meshes.text;
    int first = first_target(body), points = body->point_count;
    text_add(text, ",\"targets\":[");
    for (int k = first; k < glb->moments.count; k++) {
        text_add(text, "%s{\"POSITION\":%d", k > first ? "," : "",
                 add_difference(glb, body->x[k], body->x[0], points));
        if (body->color_count > 1)
            text_add(text, ",\"COLOR_0\":%d",
                     add_difference(glb, body->colors[k], base_colors(body), points));
        text_add(text, "}");
        if (k > first) text_add(names, ",");
        text_add_quoted(names, show_cases_frame(glb->data, &glb->cases, glb->moments.frames[k]));
    }
    text_add(text, "]");
}

/* What is not glTF's: the names of the targets, and what the colours mean. */
static void add_extras(Glb *glb, const ExportBody *body, const Text *names)
{
    Text *text = &glb->gltf.meshes.text;
    text_add(text, ",\"extras\":{\"targetNames\":[%s]", names->text ? names->text : "");
    if (body->color_count) {
        text_add(text, ",\"field\":");
        text_add_quoted(text, body->field_name);
        text_add(text, ",\"unit\":");
        text_add_quoted(text, body->field_unit);
    }
    text_add(text, "}");
}

static int add_body_mesh(Glb *glb, const ExportBody *body)
{
    Gltf *gltf = &glb->gltf;
    Text names = {0}, *text = &gltf->meshes.text;
    int mesh = gltf_next(&gltf->meshes),
        material = gltf_material(gltf, body->name, body->color_count ? white : plain, true);
    text_add(text, "{\"name\":\"%s\",\"primitives\":[{\"attributes\":{\"POSITION\":%d", body->name,
             gltf_vertices(gltf, body->x[0][0], body->point_count, 3));
    if (body->color_count)
        text_add(text, ",\"COLOR_0\":%d", gltf_vertices(gltf, base_colors(body)[0], body->point_count, 3));
    if (body->values)
        text_add(text, ",\"%s\":%d", attribute_name(glb->data, body->field_name),
                 gltf_vertices(gltf, body->values, body->point_count, 1));
    text_add(text, "},\"indices\":%d,\"material\":%d", gltf_indices(gltf, body->indices, body->index_count),
             material);
    if (body->lines) text_add(text, ",\"mode\":1");
    if (glb->moments.count > 1) add_targets(glb, body, &names);
    text_add(text, "}]");
    add_extras(glb, body, &names);
    text_add(text, "}");
    mem_free(names.text);
    return mesh;
}

/* What is far away stands there by its node, whose numbers have all digits. */
static int add_node(Gltf *gltf, const char *name, int mesh, Vec3 place)
{
    int node = gltf_next(&gltf->nodes);
    text_add(&gltf->nodes.text, "{\"name\":");
    text_add_quoted(&gltf->nodes.text, name);
    text_add(&gltf->nodes.text, ",\"mesh\":%d", mesh);
    if (vec3_length(place) > 0)
        text_add(&gltf->nodes.text, ",\"translation\":[%.17g,%.17g,%.17g]", place.x, place.y, place.z);
    text_add(&gltf->nodes.text, "}");
    return node;
}

/* At each moment its own target alone. */
static void add_body(Glb *glb, const ExportBody *body)
{
    int node = add_node(&glb->gltf, body->name, add_body_mesh(glb, body), body->middle),
        count = glb->moments.count;
    if (count < 2) return;
    int first = first_target(body), targets = count - first;
    float *weights = show_block(glb->data, (size_t)count * (size_t)targets, sizeof *weights);
    for (int k = first; k < count; k++) weights[k * targets + k - first] = 1;
    gltf_animate(&glb->gltf, node, "weights", glb->times, weights, count, targets, false);
}

/* ---- What is around ---- */

/* Faces of one colour, which are a primitive. */
static void add_part(Glb *glb, const ShowObstacle *one, int positions, int first, int count,
                     const int (*faces)[3])
{
    Gltf *gltf = &glb->gltf;
    Color color = show_obstacle_color(one, first);
    text_add(&gltf->meshes.text, "{\"attributes\":{\"POSITION\":%d},\"indices\":%d,\"material\":%d}",
             positions, gltf_indices(gltf, faces[0], 3 * count),
             gltf_material(gltf, one->name, color, false));
}

static bool same_color(const ShowObstacle *one, int a, int b)
{
    Color p = show_obstacle_color(one, a), q = show_obstacle_color(one, b);
    return p.r == q.r && p.g == q.g && p.b == q.b;
}

/* A primitive for each of its colours, which are few. */
static int add_obstacle_mesh(Glb *glb, const ShowObstacle *one)
{
    Gltf *gltf = &glb->gltf;
    int mesh = gltf_next(&gltf->meshes);
    float *points = show_block(glb->data, 3 * (size_t)one->point_count, sizeof *points);
    for (int i = 0; i < 3 * one->point_count; i++) points[i] = (float)one->points[i / 3][i % 3];
    int positions = gltf_vertices(gltf, points, one->point_count, 3);
    int(*faces)[3] = show_block(glb->data, (size_t)one->face_count, sizeof *faces);
    bool *done = show_block(glb->data, (size_t)one->face_count, sizeof *done), any = false;
    text_add(&gltf->meshes.text, "{\"name\":");
    text_add_quoted(&gltf->meshes.text, one->name);
    text_add(&gltf->meshes.text, ",\"primitives\":[");
    for (int f = 0; f < one->face_count; f++) {
        int count = 0;
        for (int g = f; g < one->face_count; g++)
            if (!done[g] && same_color(one, f, g))
                memcpy(faces[count++], one->faces[g], sizeof *faces), done[g] = true;
        if (!count) continue;
        if (any) text_add(&gltf->meshes.text, ",");
        any = true;
        add_part(glb, one, positions, f, count, (const int(*)[3])faces);
    }
    text_add(&gltf->meshes.text, "]}");
    return mesh;
}

/* The quaternion (x, y, z, w) of a rotation matrix, rows of four, by its largest part [Shepperd 1978]. */
static void quaternion(const double *R, double q[4])
{
    double trace = R[0] + R[5] + R[10], part[4] = {R[0], R[5], R[10], trace};
    int k = 0;
    for (int i = 1; i < 4; i++) k = part[i] > part[k] ? i : k;
    if (k == 3) {
        q[3] = 1 + trace;
        q[0] = R[9] - R[6], q[1] = R[2] - R[8], q[2] = R[4] - R[1];
    } else {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        q[k] = 1 + 2 * part[k] - trace;
        q[i] = R[4 * i + k] + R[4 * k + i], q[j] = R[4 * j + k] + R[4 * k + j];
        q[3] = R[4 * j + i] - R[4 * i + j];
    }
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++) q[i] /= length;
}

/* Of one thing at all moments. Where it is not there it has no size, and stands as before. */
typedef struct Way {
    float *places, *turns, *sizes; /* rows of 3, 4, 3 */
    bool moves, goes;
} Way;

static void add_moment(Way *way, int k, const double pose[12])
{
    bool there = isfinite(pose[0]), same = k > 0;
    double q[4] = {0, 0, 0, 1}, dot = 0;
    float *place = way->places + 3 * k, *turn = way->turns + 4 * k;
    if (there) quaternion(pose, q);
    for (int i = 0; k && i < 4; i++) dot += q[i] * (double)turn[i - 4]; /* of q and -q the nearer one */
    for (int i = 0; i < 4; i++) turn[i] = !there && k ? turn[i - 4] : (float)(dot < 0 ? -q[i] : q[i]);
    for (int i = 0; i < 3; i++) {
        place[i] = there ? (float)pose[4 * i + 3] : k ? place[i - 3] : 0;
        way->sizes[3 * k + i] = there;
        same &= k && place[i] == place[i - 3];
    }
    for (int i = 0; i < 4; i++) same &= k && turn[i] == turn[i - 4];
    way->moves |= k && !same;
    way->goes |= !there;
}

static void add_obstacle(Glb *glb, const ShowObstacle *one, const Way *way)
{
    Gltf *gltf = &glb->gltf;
    int mesh = add_obstacle_mesh(glb, one), node = gltf_next(&gltf->nodes), count = glb->moments.count;
    const float *s = way->places, *q = way->turns;
    text_add(&gltf->nodes.text, "{\"name\":");
    text_add_quoted(&gltf->nodes.text, one->name);
    text_add(&gltf->nodes.text,
             ",\"mesh\":%d,\"translation\":[%.9g,%.9g,%.9g],\"rotation\":[%.9g,%.9g,%.9g,%.9g]", mesh,
             (double)s[0], (double)s[1], (double)s[2], (double)q[0], (double)q[1], (double)q[2],
             (double)q[3]);
    if (way->sizes[0] == 0) text_add(&gltf->nodes.text, ",\"scale\":[0,0,0]");
    text_add(&gltf->nodes.text, "}");
    if (way->moves) {
        gltf_animate(gltf, node, "translation", glb->times, way->places, count, 3, false);
        gltf_animate(gltf, node, "rotation", glb->times, way->turns, count, 4, false);
    }
    if (way->goes && count > 1) gltf_animate(gltf, node, "scale", glb->times, way->sizes, count, 3, true);
}

static bool add_surroundings(Glb *glb, ShowObstacles *obstacles)
{
    size_t count = (size_t)glb->moments.count;
    Way *ways = show_block(glb->data, (size_t)obstacles->count, sizeof *ways);
    for (int o = 0; o < obstacles->count; o++)
        ways[o] = (Way){.places = show_block(glb->data, 3 * count, sizeof(float)),
                        .turns = show_block(glb->data, 4 * count, sizeof(float)),
                        .sizes = show_block(glb->data, 3 * count, sizeof(float))};
    for (int k = 0; k < glb->moments.count; k++) {
        const double(*poses)[12] = show_obstacles_poses(obstacles, glb->moments.frames[k]);
        for (int o = 0; o < obstacles->count; o++) add_moment(&ways[o], k, poses[o]);
    }
    for (int o = 0; o < obstacles->count; o++) add_obstacle(glb, &obstacles->list[o], &ways[o]);
    return true;
}

/* ---- The file ---- */

/* Turns z, which is up here, to y, which is up there; all else is below it. */
static void add_root(Gltf *gltf, int children)
{
    gltf_next(&gltf->nodes);
    text_add(&gltf->nodes.text, "{\"name\":\"slender\",\"rotation\":[%.9g,0,0,%.9g],\"children\":[",
             -M_SQRT1_2, M_SQRT1_2);
    for (int k = 1; k <= children; k++) text_add(&gltf->nodes.text, "%s%d", k > 1 ? "," : "", k);
    text_add(&gltf->nodes.text, "]}");
}

static bool make(Glb *glb, const ExportDef *def, Bytes *file, Error *err)
{
    ExportBody body = {0};
    ShowObstacles obstacles;
    bool rods = show_curves_has(glb->data);
    if (rods && def->field) return error_set(err, "--field is of meshes, and the result has rods");
    if (!moments_choose(glb->data, def, &glb->moments, err)) return false;
    if (!show_cases(glb->data, &glb->cases, err)) return false;
    if (!(rods ? body_of_rods : body_of_mesh)(glb->data, &glb->moments, &body, err)) return false;
    if (!show_obstacles_read(&obstacles, glb->data, err)) return false;
    if (glb->moments.count > 1)
        glb->times = gltf_numbers(&glb->gltf, glb->moments.times, glb->moments.count, 1);
    add_root(&glb->gltf, 1 + obstacles.count);
    add_body(glb, &body);
    add_surroundings(glb, &obstacles);
    return gltf_write(&glb->gltf, file, err);
}

bool export_glb(Result *result, const ExportDef *def, Bytes *file, Error *err)
{
    ShowDef show = show_default();
    ShowData data;
    show.field = def->field;
    show_data_borrow(&data, result, &show);
    Glb glb = {.data = &data};
    bool ok = make(&glb, def, file, err);
    gltf_clear(&glb.gltf);
    show_data_clear(&data);
    return ok;
}
