/* How time and memory grow with the mesh, and whether slender check foretells them: sheets of 8000 triangles and more,
 * clamped at one end, under their weight, run by the program as users run it; and scenes of other jobs. SCALE=1100000
 * in the environment goes on to a million triangles (default: 150 000). */
#include "base/clock.h"
#include "base/memory.h"
#include "bench/bench.h"
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static const char scene_name[] = "bench_scale.yaml";

/* What a program has said and used. */
typedef struct Ran {
    double seconds, cpu, megabytes;
    char text[8192];
} Ran;

static Ran run(const char *const *arguments)
{
    int pipes[2], status;
    if (pipe(pipes)) bench_fail("no pipe");
    double start = clock_seconds();
    pid_t child = fork();
    if (child == 0) {
        dup2(pipes[1], 1);
        close(pipes[0]);
        execv(PROGRAM, (char *const *)arguments);
        _exit(127);
    }
    close(pipes[1]);
    Ran ran = {0};
    size_t used = 0;
    ssize_t got;
    while ((got = read(pipes[0], ran.text + used, sizeof ran.text - 1 - used)) > 0) used += (size_t)got;
    close(pipes[0]);
    struct rusage usage;
    wait4(child, &status, 0, &usage);
    if (!WIFEXITED(status) || WEXITSTATUS(status) > 1)
        bench_fail("slender %s %s fails", arguments[1], arguments[2]);
    ran.seconds = clock_seconds() - start;
    ran.cpu = (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
              1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
    ran.megabytes = 1e-3 * (double)usage.ru_maxrss;
    return ran;
}

/* The number before that word in what was said. */
static double number_before(const Ran *ran, const char *word)
{
    const char *at = strstr(ran->text, word);
    if (!at) bench_fail("'%s' is not in: %s", word, ran->text);
    while (at > ran->text && at[-1] == ' ') at--;
    while (at > ran->text && !strchr(" (,", at[-1])) at--;
    return atof(at);
}

typedef struct Foretold {
    double factor, other; /* s: of one factorisation, and of what else there is in an iteration */
    double start, end, total, megabytes;
} Foretold;

static Foretold foretold(const Ran *check)
{
    double factor = number_before(check, " s for each factorisation"),
           iteration = number_before(check, " s, with"),
           count = number_before(check, " of these are assumed");
    return (Foretold){.factor = factor,
                      .other = iteration - count * factor,
                      .start = number_before(check, " s to prepare"),
                      .end = number_before(check, " s for stability"),
                      .total = number_before(check, " s in all"),
                      .megabytes = number_before(check, " MB of memory")};
}

static void print(const char *name, const char *what, double value, const char *unit)
{
    char full[160];
    snprintf(full, sizeof full, "%s_%s", name, what);
    bench_print(full, value, unit);
}

/* ---- Sheets ---- */

enum { SIZES = 5 };

static const int cells[SIZES][2] = {{91, 45}, {182, 90}, {364, 180}, {728, 360}, {1024, 512}};

static void write_scene(const int *size, const char *bending)
{
    FILE *file = fopen(scene_name, "w");
    if (!file) bench_fail("%s cannot be written", scene_name);
    fprintf(file,
            "slender: 1\njob: equilibrium\nshell:\n"
            "  mesh: {shape: sheet, size: [0.2, 0.1], cells: [%d, %d]}\n"
            "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.45\n  density: 1000\n  bending: %s\n"
            "  gravity: [0, 0, -0.1]\nfix:\n  - {group: root, clamp: true}\n",
            size[0], size[1], bending);
    fclose(file);
}

/* MB that can still be had; a size that would need more is left out. */
static double available_megabytes(void)
{
    char line[160];
    double kB = INFINITY;
    FILE *file = fopen("/proc/meminfo", "r");
    while (file && fgets(line, sizeof line, file)) sscanf(line, "MemAvailable: %lf", &kB);
    if (file) fclose(file);
    return 1e-3 * kB;
}

typedef struct Row {
    double triangles, check, seconds, cpu, megabytes, iterations, factorizations;
} Row;

/* False where there is too little memory. */
static bool sheet(const int *size, const char *bending, Row *to)
{
    const char *check[] = {"slender", "check", scene_name, NULL},
               *job[] = {"slender", "run", scene_name, "--force", "-o", "bench_scale", NULL};
    write_scene(size, bending);
    Ran checked = run(check);
    Foretold f = foretold(&checked);
    if (f.megabytes > 0.75 * available_megabytes()) return false;
    Ran ran = run(job);
    Row row = *to = (Row){.triangles = 2.0 * size[0] * size[1],
                          .check = checked.seconds,
                          .seconds = ran.seconds,
                          .cpu = ran.cpu,
                          .megabytes = ran.megabytes,
                          .iterations = number_before(&ran, " Newton iterations"),
                          .factorizations = number_before(&ran, " factorisations")};
    char name[80];
    snprintf(name, sizeof name, "scale_%s_%.0f", bending, row.triangles);
    double predicted = f.start + row.iterations * f.other + row.factorizations * f.factor + f.end;
    print(name, "check_seconds", row.check, "s");
    print(name, "seconds", row.seconds, "s");
    print(name, "cpu_seconds", row.cpu, "s");
    print(name, "us_per_triangle_and_iteration", 1e6 * row.cpu / row.triangles / row.iterations, "us");
    print(name, "megabytes", row.megabytes, "MB");
    print(name, "kB_per_triangle", 1e3 * row.megabytes / row.triangles, "kB");
    print(name, "iterations", row.iterations, "");
    print(name, "factorisations", row.factorizations, "");
    print(name, "predicted_over_cpu_seconds", predicted / row.cpu, "ratio");
    print(name, "predicted_over_megabytes", f.megabytes / row.megabytes, "ratio");
    return true;
}

/* The slope of log(value) over log(triangles). */
static double exponent(const Row *rows, int count, double (*value)(const Row *))
{
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (int k = 0; k < count; k++) {
        double a = log(rows[k].triangles), b = log(value(&rows[k]));
        n++, x += a, y += b, xx += a * a, xy += a * b;
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

static double seconds_per_factorization(const Row *row)
{
    return row->cpu / row->factorizations;
}
/* The program and its picture have 130 MB at any size. */
static double megabytes(const Row *row)
{
    return row->megabytes - 130;
}
static double check_seconds(const Row *row)
{
    return row->check;
}

static void sheets(const char *bending, double most)
{
    Row rows[SIZES];
    int count = 0;
    while (count < SIZES && 2.0 * cells[count][0] * cells[count][1] <= most &&
           sheet(cells[count], bending, &rows[count]))
        count++;
    if (count < 2) return;
    char name[80];
    snprintf(name, sizeof name, "scale_%s_exponent", bending);
    print(name, "cpu_seconds_per_factorisation", exponent(rows, count, seconds_per_factorization), "");
    print(name, "megabytes_beyond_130", exponent(rows, count, megabytes), "");
    print(name, "check_seconds", exponent(rows, count, check_seconds), "");
}

/* ---- Jobs of scenes ---- */

static void scene_job(const char *scene, const char *setting)
{
    char *path = mem_format("%s/scenes/%s.yaml", SOURCE_DIR, scene), *name = mem_format("scale_%s", scene);
    const char *check[] = {"slender", "check", path, "--set", setting, NULL},
               *job[] = {"slender", "run",     path, "--set",       setting, "--threads",
                         "1",       "--force", "-o", "bench_scale", NULL};
    Ran checked = run(check), ran = run(job);
    Foretold f = foretold(&checked);
    print(name, "cpu_seconds", ran.cpu, "s");
    print(name, "megabytes", ran.megabytes, "MB");
    print(name, "predicted_over_cpu_seconds", f.total / ran.cpu, "ratio");
    print(name, "predicted_over_megabytes", f.megabytes / ran.megabytes, "ratio");
    mem_free(path);
    mem_free(name);
}

void bench_scale(void)
{
    const char *most = getenv("SCALE");
    double triangles = most ? atof(most) : 150000;
    sheets("hinge", triangles);
    sheets("midedge", triangles);
    scene_job("bending", "output.precision=double");
    scene_job("twisting", "output.precision=double");
    scene_job("hexagram", "design.iterations=8");
    scene_job("hexagram_motion", "time.steps=200");
    scene_job("strip_vibration", "time.steps=400");
    scene_job("letter_a", "design.iterations=6");
    scene_job("letter_s_m", "design.iterations=6");
    scene_job("kirigami_height", "design.iterations=5");
    scene_job("track_line", "design.iterations=2");
    scene_job("rod_equilibrium", "output.precision=double");
}
