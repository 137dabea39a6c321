/* NumPy's format 1.0 of arrays [NEP 1], a member of the archive each. */
#include "base/memory.h"
#include "export/export.h"
#include "export/zip.h"
#include <stdio.h>
#include <string.h>

/* "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }", padded so that numbers begin at a multiple of 64. */
static void add_header(Bytes *npy, const char *type, const int *dims, int rank)
{
    enum { ALIGNED = 64, BEFORE = 10 };
    char shape[64] = "", header[192];
    int at = 0;
    for (int r = 0; r < rank; r++) at += snprintf(shape + at, sizeof shape - (size_t)at, "%d, ", dims[r]);
    int length = snprintf(header, sizeof header, "{'descr': '%s', 'fortran_order': False, 'shape': (%s), }",
                          type, shape);
    int padded = (BEFORE + length + 1 + ALIGNED - 1) / ALIGNED * ALIGNED - BEFORE;
    bytes_add(npy, "\x93NUMPY\1\0", 8);
    bytes_add_u16(npy, (unsigned)padded);
    bytes_add_text(npy, header);
    for (int k = length; k < padded - 1; k++) bytes_add_text(npy, " ");
    bytes_add_text(npy, "\n");
}

/* The next character of UTF-8 (U+FFFD for a byte that is none). */
static uint32_t next_character(const unsigned char **at)
{
    const unsigned char *c = *at;
    int more = *c < 0x80                 ? 0
               : *c >= 0xc2 && *c < 0xe0 ? 1
               : (*c & 0xf0) == 0xe0     ? 2
               : *c >= 0xf0 && *c < 0xf5 ? 3
                                         : -1;
    uint32_t character = more <= 0 ? *c : *c & (0x3fu >> more);
    for (int k = 1; k <= more; k++) {
        if ((c[k] & 0xc0) != 0x80) more = -1;
        character = character << 6 | (c[k] & 0x3fu);
    }
    *at += more < 0 ? 1 : 1 + more;
    return more < 0 ? 0xfffd : character;
}

/* One string of NumPy's, which has four bytes for each character. */
static void add_text(Bytes *npy, const char *text)
{
    Bytes characters = {0};
    for (const unsigned char *c = (const unsigned char *)text; *c;)
        bytes_add_u32(&characters, next_character(&c));
    char type[32];
    if (!characters.size) bytes_add_u32(&characters, 0);
    snprintf(type, sizeof type, "<U%zu", characters.size / 4);
    add_header(npy, type, NULL, 0);
    bytes_add(npy, characters.data, characters.size);
    bytes_clear(&characters);
}

static bool add_member(Zip *zip, const char *path, const Bytes *npy, Error *err)
{
    char *name = mem_format("%s.npy", path);
    bool ok = zip_add(zip, name, npy->data, npy->size, err);
    mem_free(name);
    return ok;
}

static bool add_array(Zip *zip, const char *name, const Array *array, Error *err)
{
    Bytes npy = {0};
    if (array->type == ARRAY_TEXT) {
        add_text(&npy, array->data);
    } else {
        add_header(&npy, array->type == ARRAY_INT32 ? "<i4" : "<f8", array->dims, array->rank);
        bytes_add(&npy, array->data, array_bytes(array));
    }
    bool ok = add_member(zip, name, &npy, err);
    bytes_clear(&npy);
    return ok;
}

/* Of all steps, one after the other. */
static bool add_steps(Zip *zip, Result *result, const char *path, Error *err)
{
    int steps = result_step_count(result);
    const char *name = path + strlen("VTKHDF/");
    Bytes npy = {0};
    bool ok = true;
    size_t size = 0;
    for (int k = 0; ok && k < steps; k++) {
        Array array;
        ok = result_read_step(result, name, k, &array, err);
        if (!ok) break;
        int dims[ARRAY_MAX_RANK + 1] = {steps};
        for (int r = 0; r < array.rank; r++) dims[r + 1] = array.dims[r];
        if (k == 0) add_header(&npy, "<f8", dims, array.rank + 1);
        if (k == 0) size = array_bytes(&array);
        ok = array_bytes(&array) == size || error_set(err, "%s has not the same shape in all frames", path);
        if (ok) bytes_add(&npy, array.data, size);
        array_clear(&array);
    }
    ok = ok && add_member(zip, path, &npy, err);
    bytes_clear(&npy);
    return ok;
}

static bool begins(const char *path, const char *with)
{
    return !strncmp(path, with, strlen(with));
}

static bool is_of_steps(const char *path)
{
    return !strcmp(path, "VTKHDF/Points") || begins(path, "VTKHDF/CellData/") ||
           begins(path, "VTKHDF/PointData/");
}

/* What is below slender/ without that word; of VTKHDF what changes from step to step, and when: the rest says how VTK has it. */
static bool add_dataset(Zip *zip, Result *result, const char *path, Error *err)
{
    static const char slender[] = "slender/";
    if (is_of_steps(path)) return add_steps(zip, result, path, err);
    if (!begins(path, slender) && strcmp(path, "VTKHDF/Steps/Values") != 0) return true;
    Array array;
    if (!result_read(result, path, &array, err)) return false;
    bool ok = add_array(zip, begins(path, slender) ? path + strlen(slender) : path, &array, err);
    array_clear(&array);
    return ok;
}

bool export_npz(Result *result, Bytes *file, Error *err)
{
    char **paths;
    int count;
    if (!result_list(result, &paths, &count, err)) return false;
    Zip zip = {.file = file};
    bool ok = true;
    for (int k = 0; ok && k < count; k++) ok = add_dataset(&zip, result, paths[k], err);
    Array status;
    if (ok && result_read(result, "slender/status", &status, NULL)) {
        ok = add_array(&zip, "status", &status, err);
        array_clear(&status);
    }
    zip_end(&zip);
    mem_free(paths);
    return ok;
}
