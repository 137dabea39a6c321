/* Blocks of parameters: as many as one likes, each where it was put. */
#include "solve/params.h"
#include "base/memory.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

static void test_layout(void **state)
{
    (void)state;
    enum { BLOCKS = 100 };
    long live = mem_live_count();
    Params params = {0};
    char names[BLOCKS][8];
    int offsets[BLOCKS], size = 0;
    for (int b = 0; b < BLOCKS; b++) {
        snprintf(names[b], sizeof names[b], "b%d", b);
        offsets[b] = params_add(&params, names[b], "T", b % 5, 1 + b % 3, b % 2);
    }
    double *p = params_vector(&params);
    for (int b = 0; b < BLOCKS; b++) {
        const ParamBlock *block = params_find(&params, names[b]);
        assert_true(block == &params.blocks[b] && block->offset == offsets[b] && offsets[b] == size);
        size += block->count * block->width;
    }
    assert_int_equal(params.size, size);
    for (int i = 0; i < size; i++) assert_true(p[i] == 0);
    assert_null(params_find(&params, "none"));
    mem_free(p);
    params_clear(&params);
    assert_int_equal(mem_live_count(), live);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_layout)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
