/* leaks.h - a teardown for tests: all memory that a test has taken is given back. */
#pragma once
#include "base/memory.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static int nothing_leaks(void **state)
{
    (void)state;
    assert_int_equal(mem_live_count(), 0);
    return 0;
}
