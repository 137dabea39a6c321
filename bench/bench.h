/* bench.h - the cases, each of which prints its figures. */
#pragma once

void bench_print(const char *name, double value, const char *unit);

/* Says why there is no figure, and ends with 1. */
_Noreturn void bench_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

void bench_shell_hessian(void);
void bench_newton(void);
void bench_factor(void);
void bench_couple(void);
void bench_solver(void);
void bench_spread(void);
void bench_design(void);
void bench_march(void);
void bench_contact(void);
void bench_crumple(void);
void bench_trajectory(void);

/* Of a motion in scenes/, with what is set of it: milliseconds per step, and what its adjoint and a Gauss-Newton product cost. */
void bench_sweeps(const char *name, const char *const assignments[2]);
void bench_rod(void);
void bench_spline(void);
void bench_draw(void);
void bench_equilibria(void);
void bench_scale(void);
void bench_solid(void);
