/* Obstacles of closed meshes: their distances, and what is refused. */
#include "base/random.h"
#include "tests/obstacle_fixture.h"

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
                                       cmocka_unit_test(test_mesh_surface)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
