/* Rods: natural shapes, equilibria, steps of time, stability. */
#include "base/clock.h"
#include "base/memory.h"
#include "bench/bench.h"
#include "rod/inverse.h"
#include "rod/rod.h"
#include "solve/march.h"
#include "solve/ramp.h"
#include <math.h>

static const double young = 5e6, radius = 1.5e-3;

static bool helix(void *self, double u, Vec3 *x)
{
    (void)self;
    *x = vec3(0.015 * cos(u), 0.015 * sin(u), -0.00318 * u);
    return true;
}

static RodCurve helix_curve(int elements)
{
    RodCurve curve;
    Error err;
    if (!rod_curve_create(helix, NULL, 0, 19.565163762857, elements, &curve, &err))
        bench_fail("%s", err.text);
    return curve;
}

/* Moments and natural shape of a hanging curve, ns per segment; best of `times`. */
static double invert(const RodCurve *curve, int times)
{
    RodSection section = rod_circle(radius, young, 0.5, 1200);
    RodLoads loads = {.line = vec3(0, 0, -9.8 * section.mass)};
    size_t nodes = (size_t)curve->elements + 1;
    Vec3 *moment = mem_alloc(2 * nodes, sizeof *moment), *natural = mem_alloc(nodes, sizeof *natural);
    double best = INFINITY;
    for (int k = 0; k < times; k++) {
        double start = clock_seconds();
        rod_moments(curve, loads, moment);
        rod_invert(curve, rod_alike(&section), moment, NULL, natural);
        best = fmin(best, clock_seconds() - start);
    }
    mem_free(moment);
    mem_free(natural);
    return 1e9 * best / curve->elements;
}

/* A rod that rests on the helix, in p and in its natural state. */
typedef struct Hanging {
    RodCurve curve;
    Rod *rod;
    double *p;
    System *sys;
    State state;
} Hanging;

static Hanging hanging_create(int elements)
{
    Hanging o = {.curve = helix_curve(elements)};
    size_t stations = 2 * (size_t)elements + 1;
    RodFrame *frames = mem_alloc(stations, sizeof *frames);
    rod_frenet(&o.curve, frames);
    rod_bishop(&o.curve, frames[0].n1, frames);
    o.rod = rod_create(elements, o.curve.length, rod_circle(radius, 1, 0.5, 1200), NULL);
    o.p = mem_alloc((size_t)o.rod->params.size, sizeof *o.p);
    rod_default_params(o.rod, young, o.p);
    o.p[o.rod->gravity + 2] = -9.8;
    o.sys = rod_hanging_system(o.rod);
    o.state = system_state(o.sys);
    rod_follow_curves(o.rod, &o.curve, &frames, o.state.x);
    RodLayout layout = rod_layout(o.rod, false);
    rod_balance(o.rod, o.sys, &layout, 0, o.state.x, o.p);
    mem_free(frames);
    return o;
}

static void hanging_clear(Hanging *o)
{
    rod_curve_clear(&o->curve);
    system_destroy(o->sys);
    rod_destroy(o->rod);
    mem_free(o->p);
    state_destroy(&o->state);
}

/* From the natural shape to the helix; the system made anew each time, as a job does. Best of `times`. */
static void statics(int elements, int times, const char *name, const char *factor_name)
{
    Hanging o = hanging_create(elements);
    RodLayout layout = rod_layout(o.rod, false);
    NewtonDef def = newton_default();
    def.step_cap = 1.5;
    double best = INFINITY, part = 0;
    for (int k = 0; k < times; k++) {
        double start = clock_seconds();
        System *sys = rod_hanging_system(o.rod);
        rod_natural_state(o.rod, &layout, o.p, o.state.x);
        NewtonInfo info = newton_minimize(sys, &def, &(Point){.p = o.p}, &o.state, NULL);
        double seconds = clock_seconds() - start;
        if (info.status != NEWTON_CONVERGED) bench_fail("%s: %s", name, newton_status_name(info.status));
        if (seconds < best) best = seconds, part = system_info(sys).factor_seconds / seconds;
        system_destroy(sys);
    }
    bench_print(name, 1e3 * best, "ms");
    bench_print(factor_name, part, "");
    hanging_clear(&o);
}

/* From the natural shape, steps of 10 ms. */
static void motion(void)
{
    Hanging o = hanging_create(200);
    RodLayout layout = rod_layout(o.rod, true);
    System *sys = rod_system(o.rod, young, true);
    MarchDef def = march_default();
    def.newton.step_cap = 1.5;
    State now = system_state(sys);
    rod_natural_state(o.rod, &layout, o.p, now.x);
    int steps = 200, newton = 0;
    double start = clock_seconds();
    for (int k = 0; k < steps; k++) {
        MarchInfo info;
        if (!march_step(sys, &def, 0.01, o.p, &now, &info)) bench_fail("a rod's motion stops in step %d", k);
        newton += info.newton.iterations;
    }
    bench_print("rod_march_200_ms_per_step", 1e3 * (clock_seconds() - start) / steps, "ms");
    bench_print("rod_march_200_newton_per_step", (double)newton / steps, "");
    state_destroy(&now);
    system_destroy(sys);
    hanging_clear(&o);
}

void bench_rod(void)
{
    RodCurve curve = helix_curve(50000);
    bench_print("rod_invert_50000_ns_per_segment", invert(&curve, 20), "ns");
    rod_curve_clear(&curve);
    curve = helix_curve(100);
    bench_print("rod_invert_1900x100_ms", 1e-6 * 100 * 1900 * invert(&curve, 1900), "ms");
    rod_curve_clear(&curve);
    statics(200, 20, "rod_helix_200_ms", "rod_helix_200_factor_part");
    statics(2000, 5, "rod_helix_2000_ms", "rod_helix_2000_factor_part");
    statics(50000, 3, "rod_helix_50000_ms", "rod_helix_50000_factor_part");
    motion();
}
