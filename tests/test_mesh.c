/* The mesh: neighbours of small surfaces by hand, invariants of large ones, and every refusal with its
 * sentence. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>
#include "base/memory.h"
#include "base/random.h"
#include "base/vec3.h"
#include "base/weld.h"
#include "surface/mesh.h"
#include "surface/shapes.h"

/* A file on the stack: vertices on lines 1, 2, ..., faces on lines 21, 22, ... */
typedef struct Surface {
    MeshFile file;
    double vertices[16][3];
    int vertex_line[16], faces[16][3], face_line[16];
} Surface;

static MeshFile *surface_file(Surface *s, int vertex_count, int face_count)
{
    for (int i = 0; i < 16; i++) s->vertex_line[i] = 1 + i, s->face_line[i] = 21 + i;
    s->file = (MeshFile){.path = "m.obj",
                         .vertex_count = vertex_count,
                         .face_count = face_count,
                         .vertices = s->vertices,
                         .vertex_line = s->vertex_line,
                         .faces = s->faces,
                         .face_line = s->face_line};
    return &s->file;
}

/* Unit square of two triangles with the diagonal 0-2. */
static Surface square(void)
{
    return (Surface){.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                     .faces = {{0, 1, 2}, {0, 2, 3}}};
}

static void assert_refused(const MeshFile *file, double weld, const char *sentence)
{
    long live = mem_live_count();
    Error err = {0};
    MeshReport report;
    assert_null(mesh_create(file, weld, &report, &err));
    assert_string_equal(err.text, sentence);
    mesh_report_clear(&report);
    assert_int_equal(mem_live_count(), live);
}

/* warnings: a line for each; NULL for none. */
static Mesh *assert_accepted(const MeshFile *file, double weld, const char *warnings)
{
    Error err = {0};
    MeshReport report;
    char said[2000] = "";
    Mesh *mesh = mesh_create(file, weld, &report, &err);
    if (!mesh) fail_msg("%s", err.text);
    for (int k = 0; k < report.warning_count; k++) {
        size_t length = strlen(said);
        snprintf(said + length, sizeof said - length, "%s%s", k ? "\n" : "", report.warnings[k]);
    }
    assert_string_equal(said, warnings ? warnings : "");
    mesh_report_clear(&report);
    return mesh;
}

/* What the header promises of every mesh. */
static void assert_consistent(const Mesh *m)
{
    int side_count = 0;
    for (int e = 0; e < m->edge_count; e++) {
        const int *v = m->edges[e];
        assert_true(v[0] < v[1]);
        if (e) assert_true(v[-2] < v[0] || (v[-2] == v[0] && v[-1] < v[1]));
        assert_int_equal(mesh_edge(m, v[1], v[0]), e);
        assert_int_equal(m->vertex_component[v[0]], m->vertex_component[v[1]]);
        for (int side = 0; side < 2; side++) {
            int f = m->edge_faces[e][side];
            if (f < 0) continue;
            int i = mesh_corner(m, f, e);
            assert_int_equal(m->face_edges[f][i], e);
            assert_int_equal(m->face_edge_sign[f][i], side == 0 ? 1 : -1);
            assert_int_equal(m->faces[f][(i + 1) % 3], v[side]);
            assert_int_equal(m->faces[f][(i + 2) % 3], v[!side]);
            side_count++;
        }
    }
    assert_int_equal(side_count, 3 * m->face_count);
}

static int euler_characteristic(const Mesh *m)
{
    return m->vertex_count - m->edge_count + m->face_count;
}

static void square_by_hand(void **state)
{
    (void)state;
    Surface s = square();
    Mesh *m = assert_accepted(surface_file(&s, 4, 2), 0, NULL);
    const int edges[5][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {2, 3}};
    const int edge_faces[5][2] = {{0, -1}, {1, 0}, {-1, 1}, {0, -1}, {1, -1}};
    const int face_edges[2][3] = {{3, 1, 0}, {4, 2, 1}};
    const signed char signs[2][3] = {{1, -1, 1}, {1, -1, 1}};
    assert_int_equal(m->edge_count, 5);
    assert_memory_equal(m->edges, edges, sizeof edges);
    assert_memory_equal(m->edge_faces, edge_faces, sizeof edge_faces);
    assert_memory_equal(m->face_edges, face_edges, sizeof face_edges);
    assert_memory_equal(m->face_edge_sign, signs, sizeof signs);
    assert_true(m->rest_area[0] == 0.5 && m->rest_area[1] == 0.5);
    assert_int_equal(m->component_count, 1);
    assert_int_equal(mesh_edge(m, 2, 0), 1);
    assert_int_equal(mesh_edge(m, 1, 3), -1);
    assert_int_equal(mesh_edge(m, 3, 3), -1);
    assert_int_equal(mesh_corner(m, 1, 2), 1);
    assert_true(mesh_edge_is_boundary(m, 0) && !mesh_edge_is_boundary(m, 1));
    double low[3], high[3];
    mesh_bounding_box(m, low, high);
    assert_true(low[0] == 0 && low[2] == 0 && high[0] == 1 && high[1] == 1 && high[2] == 0);
    assert_true(mesh_diagonal(m) == sqrt(2));
    int count, *boundary = mesh_boundary(m, &count);
    assert_int_equal(count, 4);
    mem_free(boundary);
    assert_consistent(m);
    mesh_destroy(m);
    mesh_destroy(NULL);
}

static void closed_surface_has_no_boundary(void **state)
{
    (void)state;
    Surface s = {.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                 .faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    Mesh *m = assert_accepted(surface_file(&s, 4, 4), 0, NULL);
    assert_consistent(m);
    assert_int_equal(euler_characteristic(m), 2);
    int count, *boundary = mesh_boundary(m, &count);
    assert_int_equal(count, 0);
    mem_free(boundary);
    mesh_destroy(m);
}

static void refuses_empty_meshes(void **state)
{
    (void)state;
    Surface s = square();
    assert_refused(surface_file(&s, 0, 0), 0, "m.obj: the mesh has no vertices");
    assert_refused(surface_file(&s, 4, 0), 0, "m.obj: the mesh has no faces");
}

static void refuses_bad_numbers(void **state)
{
    (void)state;
    Surface s = square();
    MeshFile *file = surface_file(&s, 4, 2);
    const char *rest = "; coordinates are finite and within 1e+06 m";
    const double bad[] = {NAN, INFINITY, -1e308, 1.5e6};
    const char *words[] = {"nan", "inf", "-1e+308", "1.5e+06"};
    for (int i = 0; i < 4; i++) {
        s.vertices[2][1] = bad[i];
        char *sentence = mem_format("m.obj:3: vertex 2 has y = %s%s", words[i], rest);
        assert_refused(file, 0, sentence);
        mem_free(sentence);
    }
    s.vertices[2][1] = 1;
    assert_refused(file, -1, "m.obj: weld must be a distance from 0 to 1e+06 m, not -1");
    assert_refused(file, NAN, "m.obj: weld must be a distance from 0 to 1e+06 m, not nan");
}

static void refuses_bad_indices(void **state)
{
    (void)state;
    Surface s = square();
    MeshFile *file = surface_file(&s, 4, 2);
    s.faces[1][2] = 4;
    assert_refused(file, 0, "m.obj:22: face 1 names vertex 4; the vertices are 0 to 3");
    s.faces[1][2] = -1;
    assert_refused(file, 0, "m.obj:22: face 1 names vertex -1; the vertices are 0 to 3");
    s.faces[1][2] = 0;
    assert_refused(file, 0, "m.obj:22: face 1 names vertex 0 twice; a face has three different vertices");
    s.faces[1][2] = 3;
    MeshGroup group = {"rim", 1, 2, (int[]){0, 1, 1, 4}};
    file->groups = &group, file->group_count = 1;
    assert_refused(file, 0, "m.obj: group 'rim' names vertex 4; the last one is 3");
    group = (MeshGroup){"top", 2, 1, (int[]){2}};
    assert_refused(file, 0, "m.obj: group 'top' names face 2; the last one is 1");
    file->face_line = NULL;
    s.faces[1][2] = 4;
    assert_refused(file, 0, "m.obj: face 1 names vertex 4; the vertices are 0 to 3");
}

static void refuses_flat_faces(void **state)
{
    (void)state;
    Surface s = square();
    MeshFile *file = surface_file(&s, 4, 2);
    s.vertices[3][0] = 0.5, s.vertices[3][1] = 0.5;
    assert_refused(
        file, 0,
        "m.obj:22: face 1 (vertices 0, 2, 3) has no area: 0 m^2, less than 1e-12 of the squared diagonal "
        "of the mesh");
    s.vertices[3][0] = 0.5 - 4e-7;
    s.vertices[3][1] = 0.5 + 4e-7;
    assert_refused(
        file, 0,
        "m.obj:22: face 1 (vertices 0, 2, 3) is a sliver: its height 5.66e-07 m is less than 1e-06 of its "
        "longest edge 1.41 m");
    s.vertices[3][0] = 0.5 - 4e-6;
    s.vertices[3][1] = 0.5 + 4e-6;
    mesh_destroy(assert_accepted(file, 0, NULL));
    for (int v = 0; v < 4; v++)
        for (int k = 0; k < 3; k++) s.vertices[v][k] = 1;
    assert_refused(
        file, 0,
        "m.obj:21: face 0 (vertices 0, 1, 2) has no area: 0 m^2, less than 1e-12 of the squared diagonal "
        "of the mesh");
}

static void refuses_an_edge_of_three_faces(void **state)
{
    (void)state;
    Surface s = {.vertices = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                 .faces = {{1, 2, 3}, {2, 1, 4}, {1, 2, 5}}};
    assert_refused(
        surface_file(&s, 6, 3), 0,
        "m.obj:23: the faces 0, 1 and 2 share the edge between vertices 1 and 2; an edge has one or two "
        "faces");
}

static void refuses_inconsistent_orientation(void **state)
{
    (void)state;
    Surface s = square();
    MeshFile *file = surface_file(&s, 4, 2);
    s.faces[1][0] = 2, s.faces[1][1] = 0;
    assert_refused(
        file, 0,
        "m.obj:22: faces 0 and 1 both run along their edge from vertex 2 to 0; neighbours must run in "
        "opposite directions: flip one (swap two of its vertices); a one-sided surface is no shell");
    s.faces[0][0] = 1, s.faces[0][1] = 0;
    mesh_destroy(assert_accepted(file, 0, NULL));
}

static void refuses_a_face_given_twice(void **state)
{
    (void)state;
    Surface s = square();
    const int back[3] = {1, 0, 2}; /* the other side up: every edge has its two faces */
    memcpy(s.faces[1], back, sizeof back);
    assert_refused(surface_file(&s, 4, 2), 0,
                   "m.obj:22: face 1 has the same three vertices as face 0; a face is given once");
}

static void refuses_a_moebius_band(void **state)
{
    (void)state;
    Surface s = {0};
    enum { N = 5 };
    for (int i = 0; i < N; i++) { /* rungs (2i, 2i + 1) half a turn around a circle */
        double a = 2 * acos(-1) * i / N;
        for (int side = 0; side < 2; side++) {
            double r = 2 + (side ? 0.5 : -0.5) * cos(a / 2);
            vec3_store(s.vertices[2 * i + side],
                       vec3(r * cos(a), r * sin(a), (side ? 0.5 : -0.5) * sin(a / 2)));
        }
        int p = 2 * i, q = p + 1, r = i < N - 1 ? p + 2 : 1, t = i < N - 1 ? p + 3 : 0;
        int faces[2][3] = {{p, q, t}, {p, t, r}};
        for (int k = 0; k < 6; k++) s.faces[2 * i + k / 3][k % 3] = faces[k / 3][k % 3];
    }
    assert_refused(
        surface_file(&s, 2 * N, 2 * N), 0,
        "m.obj:30: faces 0 and 9 both run along their edge from vertex 0 to 1; neighbours must run in "
        "opposite directions: flip one (swap two of its vertices); a one-sided surface is no shell");
}

static void removes_vertices_without_faces(void **state)
{
    (void)state;
    Surface s = {.vertices = {{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {1, 1, 0}, {8, 8, 8}, {0, 1, 0}},
                 .faces = {{0, 2, 3}, {0, 3, 5}}};
    MeshFile *file = surface_file(&s, 6, 2);
    MeshGroup groups[] = {{"points", 0, 3, (int[]){5, 1, 2}},
                          {"lines", 1, 3, (int[]){0, 2, 1, 4, 5, 0}},
                          {"top", 2, 1, (int[]){1}}};
    file->groups = groups, file->group_count = 3;
    Mesh *m = assert_accepted(file, 0,
                              "m.obj:2: 2 vertices were removed, being in no face; the first is vertex 1\n"
                              "m.obj: the group 'points' has lost 1 of its 3 vertices, being in no face\n"
                              "m.obj: the group 'lines' has lost 1 of its 3 lines, being in no face");
    assert_int_equal(m->vertex_count, 4);
    assert_memory_equal(m->file_vertex, ((int[]){0, 2, 3, 5}), 4 * sizeof(int));
    assert_memory_equal(m->vertex_of_file, ((int[]){0, -1, 1, 2, -1, 3}), 6 * sizeof(int));
    assert_memory_equal(m->faces, ((int[]){0, 1, 2, 0, 2, 3}), 6 * sizeof(int));
    assert_int_equal(mesh_group(m, "points", 0)->count, 2);
    assert_memory_equal(mesh_group(m, "points", 0)->members, ((int[]){3, 1}), 2 * sizeof(int));
    assert_int_equal(mesh_group(m, "lines", 1)->count, 2);
    assert_memory_equal(mesh_group(m, "lines", 1)->members, ((int[]){0, 1, 3, 0}), 4 * sizeof(int));
    assert_int_equal(mesh_group(m, "top", 2)->count, 1);
    assert_int_equal(mesh_group(m, "top", 2)->members[0], 1);
    assert_null(mesh_group(m, "bottom", 2));

    int v;
    Error err;
    assert_true(mesh_vertex(m, 5, &v, &err));
    assert_int_equal(v, 3);
    assert_false(mesh_vertex(m, 4, &v, &err));
    assert_string_equal(err.text, "vertex 4 is in no face and was removed");
    assert_false(mesh_vertex(m, 6, &v, &err));
    assert_string_equal(err.text, "there is no vertex 6; the mesh has vertices 0 to 5");
    assert_false(mesh_vertex(m, -1, &v, &err));
    mesh_destroy(m);

    file->vertex_line = NULL, file->vertex_count = 6;
    s.faces[1][1] = 1;
    mesh_destroy(assert_accepted(file, 0,
                                 "m.obj: 1 vertex was removed, being in no face; the first is vertex 4\n"
                                 "m.obj: the group 'lines' has lost 1 of its 3 lines, being in no face"));
}

/* Two triangles that meet along x = 0 in vertices of their own, one of them off by 1e-7. */
static Surface slit(void)
{
    return (Surface){.vertices = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {-0.0, 0, 0}, {1, 0, 0}, {1e-7, 1, 0}},
                     .faces = {{0, 1, 2}, {3, 4, 5}}};
}

static void keeps_a_slit_with_a_warning(void **state)
{
    (void)state;
    Surface s = slit();
    MeshFile *file = surface_file(&s, 6, 2);
    Mesh *m = assert_accepted(file, 0,
                              "m.obj:4: 1 vertex lies on another one and stays apart, as on a slit (vertex 3 "
                              "on vertex 0); weld joins such");
    assert_int_equal(m->vertex_count, 6);
    assert_int_equal(m->component_count, 2);
    assert_memory_equal(m->vertex_component, ((int[]){0, 0, 0, 1, 1, 1}), 6 * sizeof(int));
    mesh_destroy(m);
    s.vertices[5][0] = 0;
    m = assert_accepted(file, 0,
                        "m.obj:4: 2 vertices lie on another one and stay apart, as on a slit (vertex 3 on "
                        "vertex 0); weld joins such");
    mesh_destroy(m);
}

static void welds(void **state)
{
    (void)state;
    Surface s = slit();
    MeshFile *file = surface_file(&s, 6, 2);
    MeshGroup lines = {"seam", 1, 2, (int[]){3, 5, 0, 3}};
    file->groups = &lines, file->group_count = 1;
    Mesh *m = assert_accepted(file, 1e-6, NULL);
    assert_int_equal(m->vertex_count, 4);
    assert_int_equal(m->component_count, 1);
    assert_memory_equal(m->faces, ((int[]){0, 1, 2, 0, 3, 1}), 6 * sizeof(int));
    assert_memory_equal(m->file_vertex, ((int[]){0, 1, 2, 4}), 4 * sizeof(int));
    assert_memory_equal(m->vertex_of_file, ((int[]){0, 1, 2, 0, 3, 1}), 6 * sizeof(int));
    assert_int_equal(m->groups[0].count, 1); /* the line 0-3 has shrunk to a point */
    assert_memory_equal(m->groups[0].members, ((int[]){0, 1}), 2 * sizeof(int));
    assert_consistent(m);
    mesh_destroy(m);
    m = assert_accepted(file, 1e-8, NULL);
    assert_int_equal(m->vertex_count, 5);
    mesh_destroy(m);
    assert_refused(file, 1.2, "m.obj:21: weld: 1.2 m joins the vertices 0 and 1 of face 0; weld by less");
}

/* Against the definition, for distances from far below to far above the spacing. */
static void weld_map_agrees_with_its_definition(void **state)
{
    (void)state;
    enum { N = 400 };
    static double x[N][3];
    Random random = random_seed(7);
    for (int v = 0; v < N; v++)
        for (int k = 0; k < 3; k++)
            x[v][k] = rint(20 * random_signed(&random)) / 8 + 1e-9 * random_signed(&random);
    const double distances[] = {0, 1e-12, 1e-9, 1e-8, 0.126, 0.3, 1, 20};
    for (int d = 0; d < 8; d++) {
        int first[N];
        weld_map((const double(*)[3])x, N, distances[d], first);
        for (int v = 0; v < N; v++) {
            int expected = v;
            for (int u = v - 1; u >= 0; u--)
                if (first[u] == u && vec3_length(vec3_sub(vec3_load(x[u]), vec3_load(x[v]))) <= distances[d])
                    expected = u;
            assert_int_equal(first[v], expected);
        }
    }
}

/* Corner-connected squares, the black cells of an 11 x 11 checkerboard crossed into four: the paper's
 * kirigami. */
static void accepts_corner_connected_squares(void **state)
{
    (void)state;
    enum { N = 11, CORNERS = (N + 1) * (N + 1), BLACK = (N * N + 1) / 2 };
    static double x[CORNERS + BLACK][3];
    static int faces[4 * BLACK][3];
    for (int v = 0; v < CORNERS; v++) x[v][0] = v % (N + 1), x[v][1] = v / (N + 1);
    int middle = CORNERS, face = 0;
    for (int cell = 0; cell < N * N; cell += 2, middle++) {
        int i = cell % N, j = cell / N, a = j * (N + 1) + i;
        int corners[4] = {a, a + 1, a + N + 2, a + N + 1};
        x[middle][0] = i + 0.5, x[middle][1] = j + 0.5;
        for (int k = 0; k < 4; k++, face++)
            faces[face][0] = corners[k], faces[face][1] = corners[(k + 1) % 4], faces[face][2] = middle;
    }
    MeshFile file = {
        .path = "k.obj", .vertex_count = CORNERS + BLACK, .face_count = face, .vertices = x, .faces = faces};
    Mesh *m = assert_accepted(&file, 0, NULL);
    assert_int_equal(m->vertex_count, 205);
    assert_int_equal(m->face_count, 244);
    assert_int_equal(m->component_count, 1);
    assert_int_equal(m->edge_count, 8 * BLACK);
    int count, *boundary = mesh_boundary(m, &count);
    assert_int_equal(count, CORNERS);
    mem_free(boundary);
    assert_consistent(m);
    mesh_destroy(m);
}

static void large_meshes(void **state)
{
    (void)state;
    MeshFile file;
    Error err;
    assert_true(shape_hexagram(0.04, 204, &file, &err));
    Mesh *m = assert_accepted(&file, 0, NULL);
    assert_int_equal(m->face_count, 499392);
    assert_int_equal(euler_characteristic(m), 1);
    assert_int_equal(m->component_count, 1);
    mesh_destroy(m);
    m = assert_accepted(&file, 1e-9, NULL);
    assert_int_equal(m->vertex_count, file.vertex_count);
    mesh_destroy(m);
    mesh_file_clear(&file);
}

/* One vertex in 100 000 faces. */
static void a_fan_of_any_valence(void **state)
{
    (void)state;
    enum { N = 100000 };
    MeshFile file = {.path = "fan.obj", .vertex_count = N + 1, .face_count = N};
    file.vertices = mem_alloc(N + 1, sizeof *file.vertices);
    file.faces = mem_alloc(N, sizeof *file.faces);
    for (int i = 0; i < N; i++) {
        double a = 2 * acos(-1) * i / N;
        file.vertices[i][0] = cos(a), file.vertices[i][1] = sin(a);
        file.faces[i][0] = i, file.faces[i][1] = (i + 1) % N, file.faces[i][2] = N;
    }
    Mesh *m = assert_accepted(&file, 0, NULL);
    assert_int_equal(m->edge_count, 2 * N);
    assert_int_equal(euler_characteristic(m), 1);
    mesh_destroy(m);
    mem_free(file.vertices);
    mem_free(file.faces);
}

static void nothing_is_left(void **state)
{
    (void)state;
    assert_int_equal(mem_live_count(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(square_by_hand),
                                       cmocka_unit_test(closed_surface_has_no_boundary),
                                       cmocka_unit_test(refuses_empty_meshes),
                                       cmocka_unit_test(refuses_bad_numbers),
                                       cmocka_unit_test(refuses_bad_indices),
                                       cmocka_unit_test(refuses_flat_faces),
                                       cmocka_unit_test(refuses_an_edge_of_three_faces),
                                       cmocka_unit_test(refuses_inconsistent_orientation),
                                       cmocka_unit_test(refuses_a_face_given_twice),
                                       cmocka_unit_test(refuses_a_moebius_band),
                                       cmocka_unit_test(removes_vertices_without_faces),
                                       cmocka_unit_test(keeps_a_slit_with_a_warning),
                                       cmocka_unit_test(welds),
                                       cmocka_unit_test(weld_map_agrees_with_its_definition),
                                       cmocka_unit_test(accepts_corner_connected_squares),
                                       cmocka_unit_test(large_meshes),
                                       cmocka_unit_test(a_fan_of_any_valence),
                                       cmocka_unit_test(nothing_is_left)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
