/* The flux density around the body of a result: at each frame it is the one that the run had. */
#include "model/frame_flux.h"
#include "tests/leaks.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define NAME "test_frame_flux"
#include "tests/run_fixture.h"

#define STRIP                                                                                                \
    "slender: 1\nshell:\n  mesh: {shape: strip, size: [40 mm, 5 mm], n: 6}\n  thickness: 0.5 mm\n"           \
    "  young: 1 MPa\n  poisson: 0.4\n  magnetization: [20 kA/m, 0, 0]\n"                                     \
    "fix:\n  - {group: root, clamp: true}\n"
#define BELOW "{name: below, coil: {at: [20 mm, 0, -20 mm], radius: 15 mm, current: 2, turns: 20}}"
#define ABOVE "{name: above, coil: {at: [20 mm, 0, 30 mm], radius: 15 mm, current: -1, turns: 20}}"
#define BOTH  "flux_density:\n  - " BELOW "\n  - " ABOVE "\n"
#define EXACT "output: {precision: double}\n"

/* In each frame of the scene the field at the body's middle is frames/flux_density. */
static void check_frames(const char *scene, bool motion)
{
    double middle[3] = {0};
    FrameFlux flux;
    SlenderError trouble;
    Error err;
    Result *result =
        run_to(slender_scene_parse(scene, NULL, 0, &trouble), &trouble, false, SLENDER_NOT_CONVERGED);
    Array held = read_all(result, "slender/frames/flux_density"),
          times = read_all(result, "VTKHDF/Steps/Values");
    Array rest = read_all(result, "slender/rest");
    int frames = held.dims[0];
    for (int k = 0; k < 3 * rest.dims[0]; k++) middle[k % 3] += ((double *)rest.data)[k] / rest.dims[0];
    if (!frame_flux_open(&flux, result, &err)) fail_msg("%s", err.text);
    assert_true(flux.fields.count > 0 && frames > 1);
    for (int k = 0; k < frames; k++) {
        const double *is = (const double *)held.data + 3 * k;
        double B[3], time = motion ? ((const double *)times.data)[k] : NAN;
        assert_true(frame_flux_take(&flux, result, k, time, &err));
        frame_flux_at(&flux, middle, B);
        for (int i = 0; i < 3; i++)
            if (!(fabs(B[i] - is[i]) <= 1e-12 * vec3_length(vec3_load(is)) + 1e-17))
                fail_msg("frame %d: %g instead of %g in\n%s", k, B[i], is[i], scene);
    }
    frame_flux_clear(&flux);
    array_clear(&rest), array_clear(&held), array_clear(&times);
    result_close(result);
}

/* Sources that move, that other cases or stages have, in the ranges of a sequence and steps of a load, and whose strengths and
 * places are unknown. */
static void test_frames(void **unused)
{
    (void)unused;
    static const char *const at_rest[] = {
        STRIP EXACT "job: equilibrium\ncases:\n  - {name: a, flux_density: " BELOW "}\n"
                    "  - {name: b, flux_density: [" ABOVE ", [0, 1 mT, 0]]}\n",
        STRIP EXACT "job: equilibrium\nsequence:\n"
                    "  flux_density: {from: " BELOW ", to: [" ABOVE ", [1 mT, 0, 0]], count: 4}\n",
        STRIP EXACT "job: equilibrium\nload_steps: {count: 3, frames: true}\n" BOTH "  - [1 mT, 0, 0]\n",
        STRIP EXACT "job: equilibrium\nflux_density:\n"
                    "  - {name: ring, coil: {at: [20 mm, 0, 40 mm], radius: 20 mm, current: 1},\n"
                    "     move: [\"0\", \"0\", \"-0.01*t\"]}\n"
                    "sequence: [{time: 0}, {time: 1}, {time: 2}]\n",
        STRIP
        "output: {precision: double, every: 1}\njob: design\n" BOTH
        "target: {formula: [\"x\", \"y\", \"x*x\"]}\ndesign:\n  unknowns:\n"
        "    source_strength: {sources: [below], bounds: [-2, 2]}\n    source_move: {sources: [above]}\n"
        "  objectives: [{target: 1}]\n  iterations: 3\n"};
    static const char *const moving[] = {
        STRIP EXACT
        "job: simulate\ntime: {step: 2 ms, steps: 4}\nflux_density:\n"
        "  - [1 mT, 0, 0]\n  - [\"0\", \"1e-3*t\", \"0\"]\n"
        "  - {magnet: {at: [20 mm, 0, 40 mm], size: [9 mm, 8 mm, 6 mm], remanence: [0, 0, 1]},\n"
        "     move: [\"0\", \"0\", \"-t\"], turn: [\"20*t\", \"0\", \"0\"]}\n  - [\"x*t\", \"0\", \"0\"]\n",
        STRIP EXACT
        "job: trajectory\n" BOTH "time: {step: 5 ms, steps: 6}\ndesign:\n"
        "  unknowns: {source_strength: {per: knot, knots: 3}, source_turn: {sources: [above]}}\n"
        "  objectives: [{waypoint: {vertex: tip, at: [38 mm, 2.5 mm, 8 mm]}}]\n  iterations: 2\n"};
    for (int k = 0; k < 5; k++) check_frames(at_rest[k], false);
    for (int k = 0; k < 2; k++) check_frames(moving[k], true);
}

/* A uniform field has nothing around it; a map that is gone says so. */
static void test_none(void **unused)
{
    (void)unused;
    FrameFlux flux;
    Error err;
    Result *result = run_text(
        mem_text(STRIP "output: {precision: double}\njob: equilibrium\nflux_density: [0, 0, 1 mT]\n"));
    assert_true(!result_has(result, "slender/frames/flux_sources") && frame_flux_open(&flux, result, &err));
    assert_int_equal(flux.fields.count, 0);
    frame_flux_clear(&flux);
    result_close(result);
    FILE *file = fopen(NAME ".csv", "w");
    assert_non_null(file);
    fputs("x [mm], y [mm], z [mm], Bx [mT], By [mT], Bz [mT]\n", file);
    for (int k = 0; k < 6; k++) fprintf(file, "%d, 0, 0, 0, 0, %d\n", 10 * k - 5, k);
    assert_int_equal(fclose(file), 0);
    result = run_text(mem_text(
        STRIP "output: {precision: double}\njob: equilibrium\nflux_density: {map: {file: " NAME ".csv}}\n"));
    assert_true(frame_flux_open(&flux, result, &err));
    frame_flux_clear(&flux);
    unlink(NAME ".csv");
    assert_false(frame_flux_open(&flux, result, &err));
    assert_non_null(strstr(err.text, NAME ".csv"));
    frame_flux_clear(&flux);
    result_close(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(test_frames, nothing_leaks),
                                       cmocka_unit_test_teardown(test_none, nothing_leaks)};
    return cmocka_run_group_tests(tests, remove_run, remove_run);
}
