/* Which kernels of OpenBLAS are asked for in place of those that it chose. */
#include "solve/kernels.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static void test_wanted(void **state)
{
    (void)state;
    static const struct {
        const char *core;
        bool avx2, avx512;
        const char *wanted;
    } rows[] = {
        {"Prescott", false, false, NULL},     {"Prescott", true, false, "Haswell"},
        {"Prescott", true, true, "SkylakeX"}, {"Unknown", true, false, "Haswell"},
        {"Sandybridge", false, false, NULL},  {"Sandybridge", true, false, "Haswell"},
        {"Haswell", true, false, NULL},       {"Haswell", true, true, "SkylakeX"},
        {"Zen", true, false, NULL},           {"Zen", true, true, "SkylakeX"},
        {"Excavator", true, false, NULL},     {"SkylakeX", true, true, NULL},
        {"Cooperlake", true, true, NULL},     {"SapphireRapids", true, true, NULL},
        {"SkylakeX", true, false, NULL}, /* as the user says, and what later libraries are called */
        {"Zen9", true, true, NULL},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const char *wanted = kernels_wanted(rows[k].core, (KernelFeatures){rows[k].avx2, rows[k].avx512});
        if ((wanted == NULL) != (rows[k].wanted == NULL) || (wanted && strcmp(wanted, rows[k].wanted)))
            fail_msg("row %zu, %s: %s", k, rows[k].core, wanted ? wanted : "nothing");
    }
}

/* AVX-512 is never reported without AVX2: no processor has it so, and the kernels of SkylakeX use both. */
static void test_features(void **state)
{
    (void)state;
    KernelFeatures features = kernels_features();
    assert_true(features.avx2 || !features.avx512);
    assert_int_equal(kernels_reserve(3), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_wanted), cmocka_unit_test(test_features)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
