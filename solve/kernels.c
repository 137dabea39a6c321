#include "solve/kernels.h"
#include "base/clock.h"
#include "base/memory.h"
#include <cblas.h>
#include <dlfcn.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#define CORE_KEY    "OPENBLAS_CORETYPE"
#define THREADS_KEY "OPENBLAS_NUM_THREADS"

/* OpenBLAS's own; absent in some builds of it. */
__attribute__((weak)) void *blas_memory_alloc(int position);
__attribute__((weak)) void blas_memory_free(void *buffer);

/* Why the program could not be started again; 0: it was not tried. */
static int exec_error;

KernelFeatures kernels_features(void)
{
    KernelFeatures features = {0};
#if defined(__x86_64__) || defined(__i386__)
    features.avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    features.avx512 = features.avx2 && __builtin_cpu_supports("avx512f") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#endif
    return features;
}

/* 2: AVX-512, 1: AVX2, 0: older. Later names than these come with libraries that know more processors. */
static int level_of(const char *core)
{
    static const struct {
        const char *core;
        int level;
    } cores[] = {{"Unknown", 0},     {"Katmai", 0},      {"Coppermine", 0},   {"Northwood", 0},
                 {"Prescott", 0},    {"Banias", 0},      {"Atom", 0},         {"Core2", 0},
                 {"Penryn", 0},      {"Dunnington", 0},  {"Nehalem", 0},      {"Athlon", 0},
                 {"Opteron", 0},     {"Nano", 0},        {"Opteron_SSE3", 0}, {"Barcelona", 0},
                 {"Bobcat", 0},      {"Sandybridge", 0}, {"Bulldozer", 0},    {"Piledriver", 0},
                 {"Steamroller", 0}, {"Haswell", 1},     {"Excavator", 1},    {"Zen", 1}};
    for (size_t k = 0; k < sizeof cores / sizeof *cores; k++)
        if (!strcmp(core, cores[k].core)) return cores[k].level;
    return 2;
}

const char *kernels_wanted(const char *core, KernelFeatures features)
{
    static const char *const best[] = {NULL, "Haswell", "SkylakeX"};
    int has = features.avx512 ? 2 : features.avx2 ? 1 : 0;
    return level_of(core) < has ? best[has] : NULL;
}

/* Those of the library that is loaded, which may have been built for one processor alone. */
static const char *wanted_here(void)
{
    bool chooses = strstr(openblas_get_config(), "DYNAMIC_ARCH") != NULL;
    return chooses ? kernels_wanted(openblas_get_corename(), kernels_features()) : NULL;
}

static bool memory_is_limited(void)
{
    struct rlimit limit;
    return getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

/* Not where the loader was called as a program: /proc/self/exe is the loader then. */
static void start_again(char **argv)
{
    exec_error = ENOEXEC;
    if (!getauxval(AT_BASE)) return;
    execv("/proc/self/exe", argv);
    exec_error = errno;
}

void kernels_start(char **argv)
{
    const char *core = getenv(CORE_KEY) ? NULL : wanted_here(), *threads = getenv(THREADS_KEY);
    bool one = openblas_get_num_threads() == 1 || (threads && !strcmp(threads, "1"));
    if (core || (!one && memory_is_limited())) {
        char *before = threads ? strdup(threads) : NULL;
        if (core) setenv(CORE_KEY, core, 0);
        setenv(THREADS_KEY, "1", 1);
        start_again(argv);
        if (core) unsetenv(CORE_KEY);
        if (before) setenv(THREADS_KEY, before, 1);
        free(before);
    }
    kernels_one_thread();
}

void kernels_one_thread(void)
{
    openblas_set_num_threads(1);
}

enum { BLAS_BUFFER = 128 << 20, MOST_BUFFERS = 64 };

static bool has_room_for_buffer(void)
{
    void *room =
        mmap(NULL, BLAS_BUFFER, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room != MAP_FAILED) munmap(room, BLAS_BUFFER);
    return room != MAP_FAILED;
}

/* OpenBLAS keeps its buffers for good, and asks for one in a loop that ends when it has it: so first the same size is
 * asked for here. */
int kernels_reserve(int threads)
{
    static int held; /* buffers that OpenBLAS has by now */
    void *buffers[MOST_BUFFERS];
    int count = 0;
    if (!blas_memory_alloc || !blas_memory_free) return threads;
    while (count < threads && count < MOST_BUFFERS && (count < held || has_room_for_buffer()))
        buffers[count++] = blas_memory_alloc(0);
    for (int k = 0; k < count; k++) blas_memory_free(buffers[k]);
    if (count > held) held = count;
    return count;
}

double kernels_flops(void)
{
    enum { N = 384, REPEATS = 5 };
    double *a = mem_alloc(3 * (size_t)N * N, sizeof *a), *b = a + N * N, *c = b + N * N, best = INFINITY;
    for (int i = 0; i < 2 * N * N; i++) a[i] = 1e-3 * (i % 97);
    for (int k = 0; k < REPEATS; k++) {
        double start = clock_thread_seconds();
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, N, N, N, 1, a, N, b, N, 0, c, N);
        best = fmin(best, clock_thread_seconds() - start);
    }
    mem_free(a);
    return 2.0 * N * N * N / best;
}

const char *kernels_name(void)
{
    return openblas_get_corename();
}

const char *kernels_note(void)
{
    static _Thread_local char note[256];
    const char *wanted = wanted_here();
    note[0] = 0;
    if (wanted && exec_error)
        snprintf(note, sizeof note,
                 "slow: this processor has those of %s, but the program cannot start itself again: %s",
                 wanted, strerror(exec_error));
    else if (wanted)
        snprintf(note, sizeof note, "slow: " CORE_KEY " says so; this processor has those of %s", wanted);
    return note;
}

const char *kernels_blas_version(void)
{
    return openblas_get_config();
}

bool kernels_blas_is_fast(void)
{
    Dl_info where;
    void *dgemm = dlsym(RTLD_DEFAULT, "dgemm_");
    return dgemm && dladdr(dgemm, &where) && where.dli_fname && strstr(where.dli_fname, "openblas");
}
