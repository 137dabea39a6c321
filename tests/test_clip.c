/* Solids cut open by a plane: the cut closes the surface without gaps, wherever the body has gone, and is as large as it has
 * to be. */
#include "base/vec3.h"
#include "leaks.h"
#include "solid_fixture.h"
#include "view/clip.h"
#include <stdlib.h>

static const double size[3] = {3, 2, 1};
static const int cells[3] = {3, 2, 2};

/* A box of irregular tetrahedra as results have it. */
typedef struct Body {
    Tets *tets;
    int *cell_of_face;
    ClipBody clip;
} Body;

static Body make_body(int order)
{
    Error err;
    MeshFile file = box_mesh(size, cells, 0.2);
    Body body = {.tets = tets_create(&file, order, NULL, &err)};
    assert_non_null(body.tets);
    mesh_file_clear(&file);
    const Tets *tets = body.tets;
    body.cell_of_face = mem_alloc((size_t)tets->skin->face_count, sizeof *body.cell_of_face);
    for (int f = 0; f < tets->skin->face_count; f++) body.cell_of_face[f] = tets->behind[tets->skin_face[f]];
    body.clip = (ClipBody){.vertex_count = tets_node_count(tets),
                           .face_count = tets->skin->face_count,
                           .cell_count = tets->count,
                           .cell_nodes = tets->each,
                           .rest = (const double(*)[3])tets->surface->rest,
                           .faces = (const int(*)[3])tets->skin->faces,
                           .cells = tets->nodes,
                           .cell_of_face = body.cell_of_face};
    return body;
}

static void clear_body(Body *body)
{
    tets_destroy(body->tets);
    mem_free(body->cell_of_face);
}

static double area_of(const Clip *clip, const double (*x)[3], int face)
{
    const int *v = clip->faces[face];
    Vec3 a = vec3_load(x[v[0]]);
    return 0.5 * vec3_length(vec3_cross(vec3_sub(vec3_load(x[v[1]]), a), vec3_sub(vec3_load(x[v[2]]), a)));
}

/* Of the cut, and of what is left of the surface. */
static void areas_of(const Clip *clip, const double (*x)[3], double *cut, double *rest)
{
    *cut = *rest = 0;
    for (int f = 0; f < clip->face_count; f++) *(clip->face[f] < 0 ? cut : rest) += area_of(clip, x, f);
}

typedef struct Side {
    double ends[2][3];
} Side;

static int compare_points(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(double[3]));
}

static int compare_sides(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(Side));
}

/* How many edges, known by where their ends are to the last bit, do not have two faces. */
static int open_edges(const Clip *clip, const double (*x)[3])
{
    int count = 0, open = 0;
    Side *sides = mem_alloc(3 * (size_t)clip->face_count, sizeof *sides);
    for (int f = 0; f < clip->face_count; f++)
        for (int i = 0; i < 3 && area_of(clip, x, f) > 0; i++) {
            Side *side = &sides[count++];
            memcpy(side->ends[0], x[clip->faces[f][i]], sizeof side->ends[0]);
            memcpy(side->ends[1], x[clip->faces[f][(i + 1) % 3]], sizeof side->ends[1]);
            qsort(side->ends, 2, sizeof side->ends[0], compare_points);
        }
    qsort(sides, (size_t)count, sizeof *sides, compare_sides);
    for (int k = 0, end; k < count; k = end) {
        for (end = k + 1; end < count && !compare_sides(&sides[k], &sides[end]);) end++;
        open += end - k != 2;
    }
    mem_free(sides);
    return open;
}

static double (*moved(const Body *body))[3]
{
    Random random = random_seed(3);
    double(*x)[3] = mem_copy(body->clip.rest, (size_t)body->clip.vertex_count, sizeof *x);
    for (int i = 0; i < 3 * body->clip.vertex_count; i++) x[i / 3][i % 3] += 0.05 * random_signed(&random);
    return x;
}

static double (*points_of(const Clip *clip, const double (*x)[3]))[3]
{
    double(*points)[3] = mem_alloc((size_t)clip->point_count, sizeof *points);
    clip_points(clip, x, points);
    return points;
}

static void check_plane(const Body *body, ClipPlane plane, double cut, double rest)
{
    Clip clip = clip_create(&body->clip, &plane);
    double(*points)[3] = points_of(&clip, body->clip.rest), found[2];
    areas_of(&clip, (const double(*)[3])points, &found[0], &found[1]);
    if (fabs(found[0] - cut) > 1e-12 || fabs(found[1] - rest) > 1e-12)
        fail_msg("the cut has %.15g, the surface %.15g", found[0], found[1]);
    Vec3 normal = vec3_load(plane.normal);
    for (int i = 0; i < clip.point_count; i++)
        assert_true(vec3_dot(normal, vec3_sub(vec3_load(points[i]), vec3_load(plane.point))) < 1e-12);
    mem_free(points);
    clip_clear(&clip);
}

/* Cuts across cells, along their sides, obliquely and through corners. */
static void test_areas(void **state)
{
    (void)state;
    for (int order = 1; order <= 2; order++) {
        Body body = make_body(order);
        check_plane(&body, (ClipPlane){{1.3, 0, 0}, {1, 0, 0}}, 2, 2 + 2 * 1.3 * 3);
        check_plane(&body, (ClipPlane){{1.3, 0, 0}, {-5, 0, 0}}, 2, 2 + 2 * 1.7 * 3);
        check_plane(&body, (ClipPlane){{0, 0, 0.37}, {0, 0, 1}}, 6, 6 + 2 * 0.37 * 5);
        check_plane(&body, (ClipPlane){{0, 2, 0}, {2, 3, 0}}, sqrt(13), 3 + 3 + 2 + 3); /* a prism is left */
        check_plane(&body, (ClipPlane){{3, 2, 1}, {0, 1, 0}}, 3, 22 - 3); /* a side of the box itself */
        clear_body(&body);
    }
}

/* Quadratic tetrahedra are cut as they are drawn: no gap between the cut and the surface of a body that has moved. */
static void test_closed(void **state)
{
    (void)state;
    const ClipPlane planes[] = {{{1.3, 0, 0}, {1, 0, 0}}, {{1.47, 0.96, 0.53}, {0.3, -0.7, 0.4}}, {{0}, {0}}};
    for (int order = 1; order <= 2; order++)
        for (int k = 0; k < 3; k++) {
            Body body = make_body(order);
            double(*x)[3] = moved(&body);
            Clip clip = clip_create(&body.clip, &planes[k]);
            double(*points)[3] = points_of(&clip, (const double(*)[3])x);
            assert_int_equal(open_edges(&clip, (const double(*)[3])points), 0);
            assert_true(clip.face_count > 20);
            assert_int_equal(k == 2, clip.face_count == body.clip.face_count);
            mem_free(x);
            mem_free(points);
            clip_clear(&clip);
            clear_body(&body);
        }
}

/* Each face of the cut lies in the tetrahedron that it is said to lie in, each of the surface is a part of its own. */
static void test_origins(void **state)
{
    (void)state;
    Body body = make_body(2);
    Clip clip = clip_create(&body.clip, &(ClipPlane){{1.5, 1, 0.5}, {0.3, -0.7, 0.4}});
    for (int f = 0; f < clip.face_count; f++) {
        const int *nodes = body.clip.cells + 10 * clip.cell[f];
        for (int i = 0; i < 3; i++) {
            const ClipPoint *p = &clip.points[clip.faces[f][i]];
            bool from = false, to = false;
            for (int a = 0; a < 10; a++) from |= nodes[a] == p->from, to |= nodes[a] == p->to;
            assert_true(from && to);
        }
    }
    clip_clear(&clip);
    clear_body(&body);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_areas), cmocka_unit_test(test_closed),
                                       cmocka_unit_test(test_origins)};
    return cmocka_run_group_tests(tests, NULL, nothing_leaks);
}
