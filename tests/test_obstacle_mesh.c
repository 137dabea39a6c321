/* Obstacles of closed meshes: their distances, and what is refused. */
#include "base/random.h"
#include "tests/obstacle_fixture.h"
#include "world/mesh_distance.h"

/* A ball of triangles is a ball, but for what the chords cut off, the closer the finer it is. */
static double ball_error(int n, double cell)
{
    MeshFile file = make_block(n, 1, 1);
    Obstacle ball = mesh_obstacle(&file, cell);
    Random random = random_seed(7);
    double worst = 0;
    for (int k = 0; k < 2000; k++) {
        double x[3], r = 0;
        for (int i = 0; i < 3; i++) x[i] = random_signed(&random);
        for (int i = 0; i < 3; i++) r += x[i] * x[i];
        double at = 0.7 + 0.6 * random_uniform(&random);
        for (int i = 0; i < 3; i++) x[i] *= at / sqrt(r);
        worst = fmax(worst, fabs(value_at(&ball, x[0], x[1], x[2]) - (at - 1)));
    }
    obstacle_clear(&ball);
    return worst;
}

static void test_ball(void **state)
{
    (void)state;
    double coarse = ball_error(8, 0.1), fine = ball_error(24, 0.05);
    print_message("a ball of triangles: off by %.1e, %.1e\n", coarse, fine);
    assert_true(coarse < 0.02 && fine < 0.002);
}

/* Beside its faces a cube's distance is exact, and its sign is right all over; far away it is the distance, nearly. */
static void test_cube(void **state)
{
    (void)state;
    MeshFile file = make_block(2, 1, 0), turned = make_block(2, 1, 0);
    turn_faces(&turned, turned.face_count);
    Obstacle cube = mesh_obstacle(&file, NAN), other = mesh_obstacle(&turned, NAN);
    assert_near(cube.feature, sqrt(12) / 48, 1e-12);
    Random random = random_seed(3);
    for (int k = 0; k < 3000; k++) {
        double x[3], far = 0, away = 0;
        for (int i = 0; i < 3; i++) {
            x[i] = 1.3 * random_signed(&random);
            far = fmax(far, fabs(x[i]));
            away += pow(fmax(0, fabs(x[i]) - 1), 2);
        }
        Gap a, b;
        obstacle_gap(&cube, &here, x, &a);
        obstacle_gap(&other, &here, x, &b);
        assert_finite(&a, 0);
        assert_near(a.value, b.value, 1e-14);
        double exact = far < 1 ? far - 1 : sqrt(away); /* deep down and far away it is not sampled itself */
        assert_near(a.value, exact, (fabs(exact) < 6 * cube.feature ? 0.3 : 1) * cube.feature);
    }
    assert_near(value_at(&cube, 0.1, 0.2, 1.05), 0.05, 1e-6);
    assert_near(value_at(&cube, 0.1, 0.2, 0.97), -0.03, 1e-6);
    assert_near(value_at(&cube, 100, 0, 0), 99, 0.02 * 99);
    double before = 0;
    for (int k = 0; k < 4000; k++) { /* ever farther, until far beyond the grid */
        double at = 1 + 0.001 * k, value = value_at(&cube, at, 0.4 * at, -0.3 * at);
        assert_true(value > before || k == 0);
        before = value;
    }
    obstacle_clear(&cube);
    obstacle_clear(&other);
}

static void expect_refused(MeshFile *file, double cell, const char *sentence)
{
    Obstacle obstacle;
    Error err;
    assert_false(obstacle_mesh(file, cell, &obstacle, &err));
    if (!strstr(err.text, sentence)) fail_msg("%s", err.text);
    mesh_file_clear(file);
}

static void test_refused_meshes(void **state)
{
    (void)state;
    MeshFile file = make_block(2, 1, 0);
    file.face_count--;
    expect_refused(&file, NAN, "block.obj: the mesh is not closed: the edge of vertices ");
    file = make_block(2, 1, 0);
    turn_faces(&file, 1);
    expect_refused(&file, NAN, "opposite");
    file = make_block(2, 1, 0);
    expect_refused(&file, 1e-3, "block.obj: a grid with cells of 0.001 m has 8.16e+09 nodes");
    file = make_block(2, 1, 0);
    for (int v = 0; v < file.vertex_count; v++) file.vertices[v][2] *= 1e-3;
    expect_refused(&file, 0.05, "block.obj: the mesh is thinner than a cell of its grid, 0.05 m, all over");
}

/* ---- Signs: of a body of spikes and notches ---- */

static MeshFile make_spikes(void)
{
    MeshFile file = make_block(6, 1, 1);
    for (int v = 0; v < file.vertex_count; v++) {
        double *x = file.vertices[v],
               grown = sin(9 * x[0]) * sin(7 * x[1] + 1) + sin(8 * x[2]) > 0.8 ? 2 : 0.6;
        for (int i = 0; i < 3; i++) x[i] *= grown;
    }
    return file;
}

/* A tip at (0, 0, 1) over a triangle; one of its three sides is cut into many. */
static MeshFile make_needle(void)
{
    enum { PARTS = 20 };
    MeshFile file = {.path = mem_text("needle.obj"), .vertex_count = PARTS + 3, .face_count = 2 * PARTS + 2};
    file.vertices = mem_alloc(PARTS + 3, sizeof *file.vertices);
    file.faces = mem_alloc(2 * PARTS + 2, sizeof *file.faces);
    int tip = PARTS + 1, back = PARTS + 2, (*face)[3] = file.faces;
    for (int k = 0; k <= PARTS; k++)
        memcpy(file.vertices[k], (double[3]){0.1, 0.1 - 0.2 * k / PARTS, 0}, sizeof *file.vertices);
    file.vertices[tip][2] = 1;
    file.vertices[back][0] = -0.1;
    for (int k = 0; k < PARTS; k++) {
        memcpy(face++, (int[3]){k + 1, k, tip}, sizeof *face);
        memcpy(face++, (int[3]){k, k + 1, back}, sizeof *face);
    }
    memcpy(face++, (int[3]){0, back, tip}, sizeof *face);
    memcpy(face++, (int[3]){back, PARTS, tip}, sizeof *face);
    return file;
}

/* How often the faces go around a point: their solid angles by 4 pi [van Oosterom & Strackee 1983]. */
static double winding(const Mesh *mesh, const double x[3])
{
    double sum = 0;
    for (int f = 0; f < mesh->face_count; f++) {
        Vec3 r[3];
        double l[3];
        for (int k = 0; k < 3; k++) {
            r[k] = vec3_sub(vec3_load(mesh->rest[mesh->faces[f][k]]), vec3_load(x));
            l[k] = vec3_length(r[k]);
        }
        sum += atan2(vec3_dot(r[0], vec3_cross(r[1], r[2])),
                     l[0] * l[1] * l[2] + vec3_dot(r[0], r[1]) * l[2] + vec3_dot(r[1], r[2]) * l[0] +
                         vec3_dot(r[2], r[0]) * l[1]);
    }
    return sum / (2 * M_PI);
}

/* The least distance from points of a fine division of each face, which the nearest one is within `off` of. */
static double sampled_distance(const Mesh *mesh, const double x[3], double *off)
{
    enum { PARTS = 16 };
    double least = INFINITY;
    for (int f = 0; f < mesh->face_count; f++) {
        Vec3 a = vec3_load(mesh->rest[mesh->faces[f][0]]),
             ab = vec3_sub(vec3_load(mesh->rest[mesh->faces[f][1]]), a),
             ac = vec3_sub(vec3_load(mesh->rest[mesh->faces[f][2]]), a);
        for (int i = 0; i <= PARTS; i++)
            for (int j = 0; i + j <= PARTS; j++) {
                Vec3 at = vec3_axpy((double)i / PARTS, ab, vec3_axpy((double)j / PARTS, ac, a));
                double distance = vec3_length(vec3_sub(at, vec3_load(x)));
                if (distance >= least) continue;
                least = distance;
                *off = (vec3_length(ab) + vec3_length(ac)) / PARTS;
            }
    }
    return least;
}

/* At points around one, so far away at most. */
static int check_distances(MeshFile *file, const double center[3], double reach)
{
    Error err;
    Mesh *mesh = mesh_create(file, 1e-12, NULL, &err);
    if (!mesh) fail_msg("%s", err.text);
    MeshDistance *distance = mesh_distance_create(mesh);
    Random random = random_seed(11);
    int inside = 0, face = -1;
    for (int n = 0; n < 400; n++) {
        double x[3], off = 0;
        for (int i = 0; i < 3; i++) x[i] = center[i] + reach * random_signed(&random);
        double found = mesh_distance_at(distance, x, &face), sampled = sampled_distance(mesh, x, &off);
        assert_near(winding(mesh, x), found < 0 ? 1 : 0, 1e-6);
        assert_true(fabs(found) <= sampled + 1e-12 && fabs(found) >= sampled - off);
        int none = -1;
        assert_near(mesh_distance_at(distance, x, &none), found, 0);
        inside += found < 0;
    }
    mesh_distance_destroy(distance);
    mesh_destroy(mesh);
    mesh_file_clear(file);
    return inside;
}

static void test_distance(void **state)
{
    (void)state;
    MeshFile spikes = make_spikes(), needle = make_needle(), tip = make_needle();
    assert_in_range(check_distances(&spikes, (double[3]){0}, 1.3), 20, 380);
    check_distances(&needle, (double[3]){0, 0, 0.5}, 0.6);
    check_distances(&tip, (double[3]){0, 0, 1.1}, 0.2);
}

/* Its vertices go to where the spline is 0. */
static void test_mesh_surface(void **state)
{
    (void)state;
    MeshFile file = make_block(5, 1, 0), turned = make_block(5, 1, 0);
    turn_faces(&turned, turned.face_count);
    Obstacle cube = mesh_obstacle(&file, 0.1), other = mesh_obstacle(&turned, 0.1);
    check_surface(&cube, 24, 0.01);
    check_surface(&other, 24, 0.01);
    obstacle_clear(&cube);
    obstacle_clear(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ball), cmocka_unit_test(test_cube),
                                       cmocka_unit_test(test_refused_meshes),
                                       cmocka_unit_test(test_mesh_surface), cmocka_unit_test(test_distance)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
