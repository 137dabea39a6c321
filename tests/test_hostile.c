/* Results of strangers, whose check sums fit: what is not as slender writes it is refused by a sentence, whatever it
 * claims to be. */
#include "base/memory.h"
#include "io/result.h"
#include "io/safe_file.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include <hdf5.h>

static const char PATH[] = "test_hostile.vtkhdf", RAW[] = "test_hostile.h5";

/* A type of texts of that length. */
static hid_t text_type(size_t length)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, length);
    return type;
}

/* An attribute of `count` texts of 64 bytes, of which there are none in the file where they are not written. */
static void put_texts(hid_t object, const char *name, hsize_t count)
{
    char *texts = mem_alloc(count, 64);
    memset(texts, 'A', count * 64);
    hid_t space = H5Screate_simple(1, &count, NULL), type = text_type(64);
    hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(attribute >= 0 && H5Awrite(attribute, type, texts) >= 0);
    H5Aclose(attribute);
    H5Tclose(type);
    H5Sclose(space);
    mem_free(texts);
}

static hid_t put_dataset(hid_t file, const char *name, hid_t type, int rank, const hsize_t *dims,
                         hid_t properties)
{
    hid_t space = H5Screate_simple(rank, dims, NULL), links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    hid_t dataset = H5Dcreate2(file, name, type, space, links, properties, H5P_DEFAULT);
    assert_true(dataset >= 0);
    H5Pclose(links);
    H5Sclose(space);
    return dataset;
}

/* A dataset of 3 numbers that are there. */
static hid_t put_three(hid_t file, const char *name)
{
    double three[] = {1, 2, 3};
    hid_t dataset = put_dataset(file, name, H5T_NATIVE_DOUBLE, 1, (hsize_t[]){3}, H5P_DEFAULT);
    assert_true(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, three) >= 0);
    return dataset;
}

static void fill(hid_t file)
{
    hid_t unit = put_three(file, "slender/unit_texts"), group = H5Gopen2(file, "slender", H5P_DEFAULT);
    put_texts(unit, "unit", 900);
    put_texts(group, "status", 900);
    H5Dclose(unit);
    H5Gclose(group);
    H5Dclose(put_three(file, "slender/three"));
    hid_t filled = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_fill_value(filled, H5T_NATIVE_DOUBLE, &(double){7});
    H5Dclose(put_dataset(file, "slender/unwritten", H5T_NATIVE_DOUBLE, 2, (hsize_t[]){1000, 3}, filled));
    H5Pclose(filled);

    hid_t type = text_type(64), here = H5P_DEFAULT, chunks = H5Pcreate(H5P_DATASET_CREATE),
          elsewhere = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(chunks, 2, (hsize_t[]){100000, 3});
    H5Pset_external(elsewhere, "/etc/passwd", 0, 24);
    H5Dclose(put_dataset(file, "slender/texts", type, 1, (hsize_t[]){8192}, here));
    H5Dclose(put_dataset(file, "slender/huge", H5T_NATIVE_DOUBLE, 2, (hsize_t[]){1000000000, 3}, chunks));
    H5Dclose(put_dataset(file, "slender/elsewhere", H5T_NATIVE_CHAR, 1, (hsize_t[]){24}, elsewhere));
    H5Dclose(put_dataset(file, "slender/four", H5T_NATIVE_DOUBLE, 4, (hsize_t[]){1, 1, 1, 1}, here));
    H5Dclose(put_dataset(file, "slender/wide", H5T_NATIVE_LDOUBLE, 1, (hsize_t[]){1}, here));
    H5Lcreate_external("other.h5", "/x", file, "slender/link", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/slender/unit_texts", file, "slender/soft", H5P_DEFAULT, H5P_DEFAULT);
    H5Pclose(chunks);
    H5Pclose(elsewhere);
    H5Tclose(type);
}

static Result *make(void (*filler)(hid_t file))
{
    Error err;
    hid_t file = H5Fcreate(RAW, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    filler(file);
    H5Fclose(file);
    FILE *stream = fopen(RAW, "rb");
    static char bytes[1 << 22];
    size_t size = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    unlink(RAW);
    assert_true(size > 0 && size < sizeof bytes && safe_file_write(PATH, bytes, size, true, &err));
    Result *result = result_open(PATH, &err);
    if (!result) fail_msg("%s", err.text);
    return result;
}

static void test_texts_and_sizes(void **state)
{
    (void)state;
    static const char *const refused[] = {"slender/texts", "slender/huge",   "slender/elsewhere",
                                          "slender/four",  "slender/wide",   "slender/link",
                                          "slender/soft",  "slender/status", "slender/unit_texts"};
    long blocks = mem_live_count();
    Error err;
    Array array;
    Result *result = make(fill);
    for (size_t k = 0; k < sizeof refused / sizeof *refused; k++)
        if (result_read(result, refused[k], &array, &err)) fail_msg("%s is read", refused[k]);
    assert_string_equal(err.text, "the unit of slender/unit_texts is no text");
    assert_true(result_read(result, "slender/unwritten", &array, &err));
    assert_true(array_count(&array) == 3000 && ((const double *)array.data)[2999] == 7);
    array_clear(&array);
    assert_true(result_read(result, "slender/three", &array, &err));
    assert_string_equal(array.unit, "");
    assert_true(((const double *)array.data)[2] == 3);
    array_clear(&array);
    assert_false(result_read_as(result, "slender/three", ARRAY_FLOAT64, 2, 3, &array, &err));
    assert_string_equal(err.text, "slender/three is not as slender writes it");
    assert_false(result_read_as(result, "slender/three", ARRAY_INT32, 1, 3, &array, &err));
    result_close(result);
    assert_int_equal(mem_live_count(), blocks);
}

static void fill_deep(hid_t file)
{
    H5Dclose(put_three(file, "1/2/3/4/5/6/7/8/9"));
}

static void fill_many(hid_t file)
{
    hid_t group = H5Gcreate2(file, "slender", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    char name[32];
    for (int k = 0; k < 3000; k++) {
        snprintf(name, sizeof name, "%d", k);
        H5Gclose(H5Gcreate2(group, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    }
    H5Gclose(group);
}

/* A name that is longer than any of ours. */
static void fill_long(hid_t file)
{
    char name[2000];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = 0;
    H5Dclose(put_three(file, name));
}

static void test_listing(void **state)
{
    (void)state;
    static void (*const fillers[])(hid_t) = {fill_deep, fill_long};
    Error err;
    char **paths;
    int count;
    for (int k = 0; k < 2; k++) {
        Result *result = make(fillers[k]);
        assert_false(result_list(result, &paths, &count, &err));
        assert_string_equal(
            err.text, "what is in it is not as slender writes it: groups more than 8 deep, names of more "
                      "than 512 bytes, or more than 100000 of them");
        result_close(result);
    }
    Result *result = make(fill_many);
    assert_true(result_list(result, &paths, &count, &err) && count == 0);
    mem_free(paths);
    result_close(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_texts_and_sizes),
                                       cmocka_unit_test(test_listing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
