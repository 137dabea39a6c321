/* slender from C: a magnetised strip bends in a field; how its tip depends on its magnetisation; a motion.
 *
 *     cc tutorial.c $(pkg-config --cflags --libs slender) -lm -o tutorial && ./tutorial
 *
 * Installed elsewhere than in the system's places, PKG_CONFIG_PATH=DIR/lib/pkgconfig tells pkg-config of it, and
 * LD_LIBRARY_PATH=DIR/lib the loader; in a clone: cc -Iinclude examples/tutorial.c build/libslender.so -Wl,-rpath,$PWD/build -lm.
 *
 * Every number is checked: the program ends with 0 where all is right. */
#include "slender.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char strip[] = "slender: 1\n"
                            "job: equilibrium\n"
                            "shell:\n"
                            "  mesh: {shape: sheet, size: [30 mm, 10 mm], cells: [12, 4]}\n"
                            "  thickness: 1 mm\n"
                            "  young: 0.1 MPa\n"
                            "  poisson: 0.5\n"
                            "  magnetization: [20000, 0, 0]\n"
                            "flux_density: [0, 0, 5 mT]\n"
                            "fix: [{group: root, clamp: true}]\n";

static void stop(const SlenderError *err)
{
    printf("%s\n", err->text);
    exit(1);
}

static void check(int right, const char *what)
{
    printf("%-60s %s\n", what, right ? "right" : "WRONG");
    if (!right) exit(1);
}

/* A block of the parameters by its name. */
static SlenderBlock find_block(const SlenderModel *model, const char *name)
{
    SlenderBlock block = {0};
    for (int k = 0; (block = slender_model_block(model, k)).name; k++)
        if (!strcmp(block.name, name)) break;
    return block;
}

/* How high the tip is: an objective of our own. dF/dx is 1 at one dof. */
static double height(SlenderState *state, int tip)
{
    return slender_state_info(state).x[3 * tip + 2];
}

/* dF/dM by the adjoint, by the tangent and by central differences. */
static void differentiate(SlenderModel *model, SlenderState *state, int tip)
{
    SlenderError err;
    SlenderModelInfo info = slender_model_info(model);
    SlenderBlock magnetization = find_block(model, "magnetization");
    double *p = slender_model_params(model, 0), *M = p + magnetization.offset;
    double *dx = calloc((size_t)info.dofs, sizeof *dx), *dp = calloc((size_t)info.params, sizeof *dp),
           *direction = calloc((size_t)info.params, sizeof *direction), slope = 0;
    dx[3 * tip + 2] = 1;
    if (slender_vjp(model, 0, state, dx, dp, &err) != SLENDER_DONE) stop(&err);

    /* Along a direction of magnetisations that differ from face to face. */
    for (int k = 0; k < 3 * magnetization.count; k++) direction[magnetization.offset + k] = sin(1.0 + k);
    for (int k = 0; k < info.params; k++) slope += dp[k] * direction[k];
    if (slender_jvp(model, 0, state, direction, dx, &err) != SLENDER_DONE) stop(&err);
    printf("dF along a direction: adjoint %.10e, tangent %.10e", slope, dx[3 * tip + 2]);
    check(fabs(slope - dx[3 * tip + 2]) < 1e-11 * fabs(slope), "");

    double size = 10, F[2]; /* A/m */
    for (int side = 0; side < 2; side++) {
        for (int k = 0; k < 3 * magnetization.count; k++)
            M[k] += (side ? -2 : 1) * size * direction[magnetization.offset + k];
        if (slender_equilibrium(model, 0, state, NULL, &err) != SLENDER_DONE) stop(&err);
        F[side] = height(state, tip);
    }
    for (int k = 0; k < 3 * magnetization.count; k++) M[k] += size * direction[magnetization.offset + k];
    double difference = (F[0] - F[1]) / (2 * size);
    printf("by differences        %.10e", difference);
    check(fabs(slope - difference) < 1e-6 * fabs(slope), "");
    free(dx);
    free(dp);
    free(direction);
}

/* Let go in a field that swings: where the tip is after 20 ms, and what the fields do to it. */
static void move(SlenderModel *model, int tip)
{
    enum { STEPS = 20 };
    SlenderError err;
    SlenderStatus status;
    double flux[STEPS][3] = {{0}}, dflux[STEPS][3], slope = 0, F[2];
    SlenderMotionDef def = {.steps = STEPS, .step = 1e-3, .flux = flux[0]};
    SlenderState *start = slender_state_create(model, 0, &err);
    int dofs = slender_model_info(model).dofs;
    double *dx = calloc((size_t)dofs, sizeof *dx), little = 1e-7; /* T */
    dx[3 * tip + 2] = 1;
    for (int n = 0; n < STEPS; n++) flux[n][2] = 5e-3 * sin(0.3 * (n + 1));
    for (int side = -1; side < 2;
         side++) { /* as it is, then with a little more and less of the field along z */
        for (int n = 0; n < STEPS && side >= 0; n++) flux[n][2] += (side ? -2 : 1) * little;
        SlenderMotion *motion = slender_simulate(model, 0, start, &def, &status, &err);
        if (status != SLENDER_DONE) stop(&err);
        SlenderState *end = slender_motion_state(motion, STEPS, &err);
        if (side >= 0) F[side] = height(end, tip);
        if (side < 0 && slender_motion_vjp(motion, 1, (int[]){STEPS}, dx, NULL, NULL, dflux[0], NULL, NULL,
                                           &err) != SLENDER_DONE)
            stop(&err);
        slender_state_destroy(end);
        slender_motion_destroy(motion);
    }
    for (int n = 0; n < STEPS; n++) slope += dflux[n][2];
    printf("dF/dB of a motion: adjoint %.8e, differences %.8e", slope, (F[0] - F[1]) / (2 * little));
    check(fabs(slope - (F[0] - F[1]) / (2 * little)) < 1e-5 * fabs(slope), "");
    slender_state_destroy(start);
    free(dx);
}

int main(void)
{
    SlenderError err;
    SlenderScene *scene = slender_scene_parse(strip, NULL, 0, &err);
    if (!scene) stop(&err);
    SlenderModel *model = slender_model_create(scene, 1, &err);
    if (!model) stop(&err);
    SlenderModelInfo info = slender_model_info(model);
    printf("slender %s: %d points, %d faces, %d dofs, %d parameters\n", slender_version(), info.points,
           info.faces, info.dofs, info.params);

    /* The point farthest along x, on the centre line. */
    int tip = 0;
    for (int v = 0; v < info.points; v++)
        if (info.rest[3 * v] > 0.03 - 1e-9 && fabs(info.rest[3 * v + 1] - 0.005) < 1e-9) tip = v;

    SlenderState *state = slender_state_create(model, 0, &err);
    if (!state) stop(&err);
    if (slender_equilibrium(model, 0, state, NULL, &err) != SLENDER_DONE) stop(&err);
    double first = height(state, tip), energies[8];
    double energy = slender_energy(model, 0, state, energies, NULL, &err);
    printf("%s after %d Newton iterations: the tip is %.3f mm high, the energy %.4g J\n",
           slender_state_info(state).status, slender_state_info(state).newton_iterations, 1e3 * first,
           energy);
    for (int k = 0; k < info.terms; k++)
        printf("    %-10s %.4g J\n", slender_model_term(model, k), energies[k]);

    /* Half the magnetisation: parameters are written where they are. */
    SlenderBlock magnetization = find_block(model, "magnetization");
    double *M = slender_model_params(model, 0) + magnetization.offset;
    for (int f = 0; f < magnetization.count; f++) M[3 * f] /= 2;
    if (slender_equilibrium(model, 0, state, NULL, &err) != SLENDER_DONE) stop(&err);
    check(height(state, tip) > 0 && height(state, tip) < first, "with half of the magnetisation it is lower");

    differentiate(model, state, tip);
    move(model, tip);
    slender_state_destroy(state);
    slender_model_destroy(model);

    /* What is wrong with a scene is one sentence. */
    slender_scene_destroy(scene);
    scene = slender_scene_parse(
        "{\"slender\": 1, \"job\": \"equilibrium\", \"shell\": {\"thickness\": \"-1 mm\"}}", NULL, 0, &err);
    printf("%s\n", err.text);
    check(!scene && err.status == SLENDER_REFUSED, "a scene that says too little is refused");
    return 0;
}
