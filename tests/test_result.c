/* The result file: what goes in comes out, steps share what does not change, and damage is refused. */
#include "base/memory.h"
#include "io/result.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

enum { VERTICES = 4, FACES = 2, FRAMES = 3 };

static const char PATH[] = "test_result.vtkhdf";

static double away; /* m, from the origin */

static double position(int frame, int i)
{
    return away + frame + i / 16.0;
} /* exact in single precision where that is 0 */

static void put_frame(Journal *journal, int frame)
{
    Error err;
    double x[3 * VERTICES], time = 0.5 * frame, young[FACES] = {frame, frame + 1}, M[3 * FACES] = {frame};
    for (int i = 0; i < 3 * VERTICES; i++) x[i] = position(frame, i);
    Array arrays[] = {array_float("x", "m", x, 2, VERTICES, 3), array_float("time", "s", &time, 0, 0, 0),
                      array_float("cell/young", "Pa", young, 1, FACES, 0),
                      array_float("cell/magnetization", "A/m", M, 2, FACES, 3)};
    assert_true(journal_put(journal, "frame", frame, arrays, frame == 1 ? 3 : 4,
                            &err)); /* frame 1 has no magnetization */
}

static const char JOURNAL[] = "test_result.run";

static Journal *make_journal(const char *path)
{
    Error err;
    unlink(JOURNAL);
    Journal *journal = journal_open(path, JOURNAL_NEW, &err);
    if (!journal) fail_msg("%s", err.text);
    int faces[3 * FACES] = {0, 1, 2, 1, 3, 2};
    double gradient[3 * VERTICES] = {1.0 / 3};
    Array meta = array_text("scene", "slender: 1\n"), statics = array_int("faces", faces, 2, FACES, 3);
    Array final[] = {array_float("final/gradient", "N", gradient, 2, VERTICES, 3),
                     array_text("status", "converged")};
    assert_true(journal_put(journal, "meta", 0, &meta, 1, &err) &&
                journal_put(journal, "static", 0, &statics, 1, &err));
    assert_true(journal_put(journal, "final", 0, final, 2, &err));
    for (int k = 0; k < FRAMES; k++) put_frame(journal, k);
    for (int k = 0; k < 4; k++) {
        double F = 1.0 / (1 + k), u[2] = {k, k};
        Array arrays[] = {array_float("objective", "", &F, 0, 0, 0), array_float("unknowns", "", u, 1, 2, 0)};
        assert_true(journal_put(journal, "evaluation", k, arrays, 2, &err));
    }
    return journal;
}

static void write_result(bool double_frames)
{
    Error err;
    Journal *journal = make_journal(JOURNAL);
    if (!result_write(journal, PATH, (ResultDef){double_frames}, NULL, &err)) fail_msg("%s", err.text);
    journal_close(journal, &err);
}

static void test_read_back(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Error err;
    Array array;
    write_result(false);
    Result *result = result_open(PATH, &err);
    if (!result) fail_msg("%s", err.text);
    assert_int_equal(result_step_count(result), FRAMES);
    for (int k = 0; k < FRAMES; k++) {
        assert_true(result_read_step(result, "Points", k, &array, &err) && array.dims[0] == VERTICES &&
                    array.dims[1] == 3);
        for (int i = 0; i < 3 * VERTICES; i++) assert_true(((const double *)array.data)[i] == position(k, i));
        array_clear(&array);
        assert_true(result_read_step(result, "CellData/magnetization", k, &array, &err));
        assert_true(*(const double *)array.data == (k == 1 ? 0 : k)); /* frame 1 shows that of frame 0 */
        array_clear(&array);
    }
    assert_true(result_read(result, "VTKHDF/CellData/magnetization", &array, &err) &&
                array.dims[0] == 2 * FACES);
    array_clear(&array);
    assert_true(result_read(result, "slender/final/gradient", &array, &err) &&
                *(const double *)array.data == 1.0 / 3);
    assert_string_equal(array.unit, "N");
    array_clear(&array);
    assert_true(result_read(result, "slender/history/objective", &array, &err) && array.dims[0] == 4 &&
                ((const double *)array.data)[3] == 0.25);
    array_clear(&array);
    assert_true(result_read(result, "slender/status", &array, &err));
    assert_string_equal(array.data, "converged");
    array_clear(&array);
    assert_true(result_read(result, "slender/state/x", &array, &err) &&
                *(const double *)array.data == position(FRAMES - 1, 0));
    array_clear(&array);
    assert_true(result_read_rows(result, "slender/faces", 1, 1, &array, &err) &&
                ((const int *)array.data)[1] == 3);
    array_clear(&array);
    assert_false(result_read(result, "slender/nothing", &array, &err));
    assert_false(result_read_step(result, "Points", FRAMES, &array, &err));
    char **paths;
    int count;
    assert_true(result_list(result, &paths, &count, &err) && count > 15);
    mem_free(paths);
    result_close(result);
    assert_int_equal(mem_live_count(), blocks);
}

/* A result has the same bytes whether its journal was a file or not. */
static void test_in_memory(void **state)
{
    (void)state;
    Error err;
    uint32_t sum[2];
    Journal *journals[] = {make_journal(JOURNAL), make_journal(NULL)};
    for (int k = 0; k < 2; k++) {
        if (!result_write(journals[k], PATH, (ResultDef){false}, &sum[k], &err)) fail_msg("%s", err.text);
        assert_true(journal_close(journals[k], &err));
    }
    assert_int_equal(sum[0], sum[1]);
}

/* Single numbers resolve a body of about 1 m at 30 m to 2e-6, and one at 100 km to 8 mm: there they are
 * double. */
static void test_far_away(void **state)
{
    (void)state;
    static const double places[] = {0, 30, 1e5 + 1e-4};
    for (int k = 0; k < 3; k++) {
        Error err;
        Array array;
        away = places[k];
        write_result(false);
        Result *result = result_open(PATH, &err);
        if (!result) fail_msg("%s", err.text);
        assert_true(result_has(result, "slender/frames/x") == (k == 2));
        assert_true(result_read_step(result, "Points", 1, &array, &err));
        for (int i = 0; i < 3 * VERTICES; i++)
            assert_true(fabs(((const double *)array.data)[i] - position(1, i)) <= (k == 2 ? 0 : 1e-5));
        array_clear(&array);
        result_close(result);
    }
    away = 0;
}

static char *read_all(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *bytes = malloc(*size + 1);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    bytes[*size] = 0;
    fclose(file);
    return bytes;
}

/* The same journal gives the same bytes. */
static void test_deterministic(void **state)
{
    (void)state;
    size_t size, size_again;
    write_result(true);
    char *first = read_all(PATH, &size);
    sleep(1);
    write_result(true);
    char *second = read_all(PATH, &size_again);
    assert_int_equal(size, size_again);
    assert_memory_equal(first, second, size);
    free(first);
    free(second);
}

static void write_all(const char *path, const char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    fwrite(bytes, 1, size, file);
    fclose(file);
}

static void test_damage(void **state)
{
    (void)state;
    Error err;
    size_t size;
    write_result(false);
    char *bytes = read_all(PATH, &size);
    for (size_t at = 0; at < size; at += size / 200) {
        bytes[at] = (char)(bytes[at] ^ 4);
        write_all(PATH, bytes, size);
        bytes[at] = (char)(bytes[at] ^ 4);
        assert_null(result_open(PATH, &err));
        write_all(PATH, bytes, at);
        assert_null(result_open(PATH, &err));
    }
    free(bytes);
    assert_null(result_open("missing.vtkhdf", &err));
    assert_string_equal(err.text, "missing.vtkhdf: cannot be read: No such file or directory");
}

/* Where it cannot be written the sentence says so, and nothing is left lying about. */
static void test_unwritable(void **state)
{
    (void)state;
    Error err;
    Journal *journal = make_journal(JOURNAL);
    assert_false(result_write(journal, "no/such/folder/x.vtkhdf", (ResultDef){0}, NULL, &err));
    assert_string_equal(err.text, "no/such/folder/x.vtkhdf: cannot be written: No such file or directory");
    journal_close(journal, &err);
}

/* h5py sees the same; skipped where there is none. */
static void test_h5py(void **state)
{
    (void)state;
    if (system("/usr/bin/python3 -c 'import h5py' 2>/dev/null")) {
        print_message("no h5py here\n");
        skip();
    }
    write_result(true);
    assert_int_equal(
        system("/usr/bin/python3 -c \""
               "import h5py; f = h5py.File('test_result.vtkhdf'); s = f['slender']; v = f['VTKHDF'];"
               "assert v.attrs['Type'] == b'UnstructuredGrid' and list(v.attrs['Version']) == [2, 0];"
               "assert v['Steps'].attrs['NSteps'] == 3 and v['Points'].shape == (12, 3);"
               "assert s.attrs['status'] in (b'converged', 'converged') and s['frames/x'].shape == (3, 4, 3);"
               "assert s['final/gradient'].attrs['unit'] in (b'N', 'N')\""),
        0);
}

/* ---- Polylines ---- */

enum { LINES = 3, POINTS = 12 };

/* Two frames of three lines; a number for each line, one for each point. */
static Journal *make_lines(const int (*lines)[2])
{
    Error err;
    unlink("test_lines.run");
    Journal *journal = journal_open("test_lines.run", JOURNAL_NEW, &err);
    if (!journal) fail_msg("%s", err.text);
    Array statics = array_int("lines", lines[0], 2, LINES, 2);
    assert_true(journal_put(journal, "static", 0, &statics, 1, &err));
    for (int frame = 0; frame < 2; frame++) {
        double x[POINTS][3], time = frame, cell[LINES] = {frame, frame + 1, frame + 2}, s[POINTS];
        for (int i = 0; i < POINTS; i++) {
            s[i] = i;
            for (int k = 0; k < 3; k++) x[i][k] = position(frame, 3 * i + k);
        }
        Array arrays[] = {array_float("x", "m", x[0], 2, POINTS, 3), array_float("time", "s", &time, 0, 0, 0),
                          array_float("cell/strand", "", cell, 1, LINES, 0),
                          array_float("point/s", "m", s, 1, POINTS, 0)};
        assert_true(journal_put(journal, "frame", frame, arrays, 4, &err));
    }
    return journal;
}

static void expect_ints(Result *result, const char *path, const int *expected, int count)
{
    Error err;
    Array array;
    if (!result_read(result, path, &array, &err)) fail_msg("%s", err.text);
    assert_int_equal(array.type, ARRAY_INT32);
    assert_int_equal(array_count(&array), count);
    assert_memory_equal(array.data, expected, (size_t)count * sizeof *expected);
    array_clear(&array);
}

static Result *write_lines(const int (*lines)[2])
{
    Error err;
    Journal *journal = make_lines(lines);
    if (!result_write(journal, "test_lines.vtkhdf", (ResultDef){true}, NULL, &err)) fail_msg("%s", err.text);
    journal_close(journal, &err);
    Result *result = result_open("test_lines.vtkhdf", &err);
    if (!result) fail_msg("%s", err.text);
    return result;
}

static void expect_sidecar(const char *words)
{
    size_t size;
    char *text = read_all("test_lines.xdmf", &size);
    if (!strstr(text, words)) fail_msg("the sidecar does not say %s:\n%s", words, text);
    free(text);
}

static void test_lines(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Error err;
    Array array;
    const int lines[LINES][2] = {{0, 4}, {4, 3}, {7, 5}};
    Result *result = write_lines(lines);
    expect_ints(result, "slender/lines", lines[0], 2 * LINES);
    expect_ints(result, "VTKHDF/Types", (const int[]){4, 4, 4}, LINES);
    expect_ints(result, "VTKHDF/Offsets", (const int[]){0, 4, 7, 12}, LINES + 1);
    expect_ints(result, "VTKHDF/Connectivity", (const int[]){0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, POINTS);
    expect_ints(result, "slender/xdmf_topology",
                (const int[]){2, 4, 0, 1, 2, 3, 2, 3, 4, 5, 6, 2, 5, 7, 8, 9, 10, 11}, 2 * LINES + POINTS);
    expect_sidecar("<Topology TopologyType=\"Mixed\" NumberOfElements=\"3\"><DataItem Dimensions=\"18\" "
                   "NumberType=\"Int\" Precision=\"8\" Format=\"HDF\">test_lines.vtkhdf:/slender/"
                   "xdmf_topology|0:1:18:18</DataItem>");
    assert_true(result_read_step(result, "Points", 1, &array, &err) && array.dims[0] == POINTS);
    assert_true(((const double *)array.data)[35] == position(1, 35));
    array_clear(&array);
    assert_true(result_read_step(result, "CellData/strand", 1, &array, &err) && array.dims[0] == LINES);
    assert_true(((const double *)array.data)[2] == 3);
    array_clear(&array);
    assert_true(result_read_step(result, "PointData/s", 1, &array, &err) && array.dims[0] == POINTS);
    assert_true(((const double *)array.data)[11] == 11);
    array_clear(&array);
    assert_true(result_read(result, "slender/state/x", &array, &err) &&
                ((const double *)array.data)[35] == position(1, 35));
    array_clear(&array);
    assert_true(result_read(result, "slender/frames/x", &array, &err) && array.rank == 3 &&
                array.dims[1] == POINTS);
    array_clear(&array);
    result_close(result);
    assert_int_equal(mem_live_count(), blocks);
}

/* XDMF's own kind of polylines has one length; these begin at any points. */
static void test_equal_lines(void **state)
{
    (void)state;
    Result *result = write_lines((const int[LINES][2]){{8, 4}, {0, 4}, {4, 4}});
    expect_ints(result, "VTKHDF/Connectivity", (const int[]){8, 9, 10, 11, 0, 1, 2, 3, 4, 5, 6, 7}, POINTS);
    assert_false(result_has(result, "slender/xdmf_topology"));
    expect_sidecar(
        "<Topology TopologyType=\"Polyline\" NumberOfElements=\"3\" NodesPerElement=\"4\"><DataItem "
        "Dimensions=\"12\"");
    result_close(result);
}

static void test_bad_lines(void **state)
{
    (void)state;
    const int bad[][LINES][2] = {
        {{0, 4}, {4, 3}, {7, 6}}, {{0, 4}, {-1, 3}, {7, 5}}, {{0, 1}, {4, 3}, {7, 5}}};
    for (int k = 0; k < 3; k++) {
        Error err;
        Journal *journal = make_lines(bad[k]);
        assert_false(result_write(journal, "test_lines.vtkhdf", (ResultDef){0}, NULL, &err));
        assert_string_equal(err.text,
                            "static/lines must be rows of a first point and a number of points, 2 or more, "
                            "among the 12 of a frame");
        journal_close(journal, &err);
    }
}

/* The names of images in memory are no names of files: another file of any name may lie here, and two results that are
 * open at once are two. */
static void test_images(void **state)
{
    (void)state;
    Error err;
    Array array;
    write_result(false);
    Journal *journal = make_lines((const int[LINES][2]){{0, 4}, {4, 3}, {7, 5}});
    write_all("slender", "a file of the program's name", 28);
    assert_true(result_write(journal, "test_lines.vtkhdf", (ResultDef){0}, NULL, &err));
    journal_close(journal, &err);
    Result *faces = result_open(PATH, &err), *lines = result_open("test_lines.vtkhdf", &err);
    unlink("slender");
    if (!faces || !lines) fail_msg("%s", err.text);
    assert_true(result_has(faces, "slender/faces") && !result_has(faces, "slender/lines"));
    assert_true(result_read(lines, "slender/lines", &array, &err));
    array_clear(&array);
    result_close(faces);
    result_close(lines);
}

static int remove_files(void **state)
{
    (void)state;
    static const char *const files[] = {"test_result.vtkhdf",   "test_result.xdmf",   "test_result.run",
                                        "test_result.run-lock", "test_lines.vtkhdf",  "test_lines.xdmf",
                                        "test_lines.run",       "test_lines.run-lock"};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) unlink(files[k]);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_read_back),     cmocka_unit_test(test_in_memory),
        cmocka_unit_test(test_deterministic), cmocka_unit_test(test_far_away),
        cmocka_unit_test(test_damage),        cmocka_unit_test(test_unwritable),
        cmocka_unit_test(test_h5py),          cmocka_unit_test(test_lines),
        cmocka_unit_test(test_equal_lines),   cmocka_unit_test(test_bad_lines),
        cmocka_unit_test(test_images)};
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
