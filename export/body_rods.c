#include "base/vec3.h"
#include "export/body.h"
#include "view/show_curves.h"
#include <math.h>

enum { SIDES = 12 };

/* Strands of nodes, and how thick they are there. */
typedef struct Strands {
    int count, node_count;
    const int *first;     /* [count + 1]  */
    const double *radius; /* [node] m; NULL: not known */
} Strands;

/* ---- Reading ---- */

static bool read_strands(ShowData *data, Strands *strands, Error *err)
{
    Array array;
    Result *result = data->result;
    if (result_has(result, "slender/rod/strands")) {
        if (!result_read_as(result, "slender/rod/strands", ARRAY_INT32, 1, 0, &array, err)) return false;
        strands->first = show_keep(data, array), strands->count = array.dims[0] - 1;
    } else {
        if (!result_read_as(result, "slender/rod/x", ARRAY_FLOAT64, 2, 3, &array, err)) return false;
        int *first = show_block(data, 2, sizeof *first);
        first[1] = array.dims[0];
        array_clear(&array);
        strands->first = first, strands->count = 1;
    }
    bool ok = strands->count > 0 && strands->first[0] == 0;
    for (int k = 0; ok && k < strands->count; k++) ok = strands->first[k + 1] >= strands->first[k] + 2;
    strands->node_count = ok ? strands->first[strands->count] : 0;
    return ok || error_set(err, "slender/rod/strands is not as slender writes it");
}

/* ---- Tubes ---- */

/* v without its part along the unit vector t, as a unit vector; any across t where nothing is left. */
static Vec3 across(Vec3 v, Vec3 t)
{
    Vec3 part = vec3_axpy(-vec3_dot(v, t), t, v);
    if (vec3_length(part) > 1e-6) return vec3_unit(part);
    return across(fabs(t.x) < 0.8 ? vec3(1, 0, 0) : vec3(0, 1, 0), t);
}

static Vec3 tangent_at(const double (*x)[3], int begin, int end, int i)
{
    int before = i > begin ? i - 1 : i, after = i + 1 < end ? i + 1 : i;
    Vec3 chord = vec3_sub(vec3_load(x[after]), vec3_load(x[before]));
    return vec3_length(chord) > 0 ? vec3_unit(chord) : vec3(1, 0, 0);
}

static void put(float *to, Vec3 v)
{
    to[0] = (float)v.x, to[1] = (float)v.y, to[2] = (float)v.z;
}

/* Rings around the nodes, whose first corners are carried along the strand without turning about it, and at last the middles
 * of its ends. `side`: where the first one points to; it comes from the moment before, so that sides stay where they are. */
static void sweep(const Strands *strands, int strand, const double (*x)[3], Vec3 *side, float (*ring)[3])
{
    int begin = strands->first[strand], end = strands->first[strand + 1];
    Vec3 n = *side;
    for (int i = begin; i < end; i++) {
        Vec3 t = tangent_at(x, begin, end, i);
        n = across(n, t);
        if (i == begin) *side = n;
        Vec3 b = vec3_cross(t, n);
        for (int k = 0; k < SIDES; k++) {
            double angle = 2 * M_PI * k / SIDES;
            Vec3 out = vec3_axpy(sin(angle), b, vec3_scale(cos(angle), n));
            put(*ring++, vec3_axpy(strands->radius[i], out, vec3_load(x[i])));
        }
    }
    put(*ring++, vec3_load(x[begin]));
    put(*ring, vec3_load(x[end - 1]));
}

static int points_before(const Strands *strands, int strand)
{
    return SIDES * strands->first[strand] + 2 * strand;
}

/* Two triangles for each side of each element, and one for each side of an end: normals point outwards. */
static int (*connect(const Strands *strands, int strand, int (*face)[3]))[3]
{
    int base = points_before(strands, strand), nodes = strands->first[strand + 1] - strands->first[strand],
        caps = base + SIDES * nodes;
    for (int k = 0; k < SIDES; k++) {
        int next = (k + 1) % SIDES;
        for (int i = 0; i + 1 < nodes; i++) {
            int here = base + SIDES * i, there = here + SIDES;
            int quad[4] = {here + k, here + next, there + next, there + k};
            for (int half = 0; half < 2; half++, face++)
                (*face)[0] = quad[0], (*face)[1] = quad[1 + half], (*face)[2] = quad[2 + half];
        }
        int last = caps - SIDES;
        (*face)[0] = caps, (*face)[1] = base + next, (*face++)[2] = base + k;
        (*face)[0] = caps + 1, (*face)[1] = last + k, (*face++)[2] = last + next;
    }
    return face;
}

static void make_tubes(ShowData *data, const Strands *strands, ExportBody *body)
{
    size_t faces = 2 * SIDES * (size_t)strands->node_count;
    int(*first)[3] = show_block(data, faces, sizeof *first), (*face)[3] = first;
    for (int s = 0; s < strands->count; s++) face = connect(strands, s, face);
    body->point_count = points_before(strands, strands->count);
    body->indices = first[0], body->index_count = 3 * (int)faces;
}

static void make_lines(ShowData *data, const Strands *strands, ExportBody *body)
{
    int *index = show_block(data, 2 * (size_t)strands->node_count, sizeof *index);
    body->indices = index, body->lines = true, body->point_count = strands->node_count;
    for (int s = 0; s < strands->count; s++)
        for (int i = strands->first[s]; i + 1 < strands->first[s + 1]; i++) *index++ = i, *index++ = i + 1;
    body->index_count = (int)(index - body->indices);
}

static const double (*from_middle(ShowData *data, Vec3 middle, const double (*x)[3], int count))[3]
{
    double(*from)[3] = show_block(data, (size_t)count, sizeof *from);
    for (int i = 0; i < count; i++) vec3_store(from[i], vec3_sub(vec3_load(x[i]), middle));
    return (const double(*)[3])from;
}

bool body_of_rods(ShowData *data, const Moments *moments, ExportBody *body, Error *err)
{
    Strands strands = {0};
    if (!read_strands(data, &strands, err)) return false;
    strands.radius = show_curves_radii(data, strands.count, strands.first);
    *body = (ExportBody){.name = "rod"};
    (strands.radius ? make_tubes : make_lines)(data, &strands, body);
    Vec3 *sides = show_block(data, (size_t)strands.count, sizeof *sides);
    const double(**x)[3] = moments_points(data, moments, "slender/rod/x", strands.node_count, err);
    if (!x) return false;
    body->middle = moments_middle(moments, x, strands.node_count);
    body->x = show_block(data, (size_t)moments->count, sizeof *body->x);
    for (int k = 0; k < moments->count; k++) {
        const double(*from)[3] = from_middle(data, body->middle, x[k], strands.node_count);
        float(*points)[3] = show_block(data, (size_t)body->point_count, sizeof *points);
        for (int s = 0; strands.radius && s < strands.count; s++)
            sweep(&strands, s, from, &sides[s], points + points_before(&strands, s));
        for (int i = 0; !strands.radius && i < body->point_count; i++) put(points[i], vec3_load(from[i]));
        body->x[k] = (const float(*)[3])points;
    }
    return true;
}
