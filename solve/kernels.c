#include "solve/kernels.h"
#include "base/clock.h"
#include "base/memory.h"
#include <cblas.h>
#include <dlfcn.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* OpenBLAS's own; absent in some builds of it. */
__attribute__((weak)) void *blas_memory_alloc(int position);
__attribute__((weak)) void blas_memory_free(void *buffer);

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

const char *kernels_better(void)
{
    bool chooses = strstr(openblas_get_config(), "DYNAMIC_ARCH") != NULL;
    return chooses ? kernels_wanted(openblas_get_corename(), kernels_features()) : NULL;
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
    static atomic_int held; /* buffers that OpenBLAS has by now */
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
    const char *better = kernels_better();
    note[0] = 0;
    if (better && getenv(KERNELS_CORE_KEY))
        snprintf(note, sizeof note, "slow: " KERNELS_CORE_KEY " says so; this processor has those of %s",
                 better);
    else if (better)
        snprintf(note, sizeof note,
                 "slow: this processor has those of %s, which " KERNELS_CORE_KEY
                 "=%s in the environment brings",
                 better, better);
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
