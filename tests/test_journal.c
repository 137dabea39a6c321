/* The journal: bits, units, modes, damage, and kills at random moments. The full campaigns are in
 * tests/campaign.sh. */
#include "base/memory.h"
#include "base/random.h"
#include "io/journal.h"
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmocka.h>

static const char PATH[] = "test_journal.run";

static void clean(void)
{
    unlink(PATH);
    unlink("test_journal.run-wal");
    unlink("test_journal.run-shm");
}

static Journal *open_fresh(void)
{
    Error err;
    clean();
    Journal *journal = journal_open(PATH, JOURNAL_NEW, &err);
    if (!journal) fail_msg("%s", err.text);
    return journal;
}

static void put_number(Journal *journal, const char *kind, int index, double value)
{
    Error err;
    Array array = array_float("value", "m", &value, 0, 0, 0);
    if (!journal_put(journal, kind, index, &array, 1, &err)) fail_msg("%s", err.text);
}

static double get_number(Journal *journal, const char *kind, int index)
{
    Error err;
    Array array;
    if (!journal_get(journal, kind, index, "value", &array, &err)) fail_msg("%s", err.text);
    double value = *(const double *)array.data;
    array_clear(&array);
    return value;
}

static int count_of(Journal *journal, const char *kind)
{
    Error err;
    int count;
    if (!journal_count(journal, kind, &count, &err)) fail_msg("%s", err.text);
    return count;
}

/* All that may be asked of a journal; closes it. */
static void round_trip(Journal *journal, const char *missing)
{
    Error err;
    double numbers[6] = {1.0 / 3, -0.0, 5e-324, 1e308, 2, 3};
    int whole[2] = {-7, 2147483647};
    Array arrays[] = {array_float("x", "m", numbers, 2, 2, 3), array_int("faces", whole, 1, 2, 0),
                      array_text("scene", "slender: 1\n"), array_float("nothing", "", numbers, 2, 0, 3)},
          got;
    assert_true(journal_put(journal, "static", 3, arrays, 4, &err));
    assert_true(journal_get(journal, "static", 3, "x", &got, &err));
    assert_true(got.rank == 2 && got.dims[0] == 2 && got.dims[1] == 3 && !strcmp(got.unit, "m"));
    assert_memory_equal(got.data, numbers, sizeof numbers);
    array_clear(&got);
    assert_true(journal_get(journal, "static", 3, "faces", &got, &err) && got.type == ARRAY_INT32);
    assert_memory_equal(got.data, whole, sizeof whole);
    array_clear(&got);
    assert_true(journal_get(journal, "static", 3, "scene", &got, &err));
    assert_string_equal(got.data, "slender: 1\n");
    array_clear(&got);
    assert_true(journal_get(journal, "static", 3, "nothing", &got, &err) && array_count(&got) == 0 &&
                got.dims[1] == 3);
    array_clear(&got);
    assert_false(journal_get(journal, "static", 4, "x", &got, &err));
    assert_string_equal(err.text, missing);
    char **names;
    int count, *indices;
    assert_true(journal_names(journal, "static", 3, &names, &count, &err) && count == 4);
    assert_string_equal(names[0], "faces");
    assert_string_equal(names[3], "x");
    mem_free(names);
    put_number(journal, "frame", 5, 1);
    put_number(journal, "frame", 2, 2);
    put_number(journal, "frame", 5, 3); /* replaces */
    assert_true(get_number(journal, "frame", 5) == 3);
    assert_true(journal_indices(journal, "frame", &indices, &count, &err) && count == 2 && indices[0] == 2 &&
                indices[1] == 5);
    mem_free(indices);
    assert_int_equal(count_of(journal, "frame"), 2);
    assert_int_equal(count_of(journal, "none"), 0);
    double value = 4;
    bool has = false;
    Array one = array_float("value", "m", &value, 0, 0, 0);
    assert_true(journal_replace(journal, "state", 1, &one, 1, &err) && get_number(journal, "state", 1) == 4);
    assert_true(journal_has(journal, "state", 1, "value", &has, &err) && has);
    assert_true(journal_find(journal, "state", 2, "value", &got, &err) && !got.data);
    assert_true(journal_flush(journal, &err) && journal_check(journal, &err));
    assert_true(journal_forget(journal, "frame", &err) && count_of(journal, "frame") == 0);
    assert_true(!journal_is_finished(journal) && journal_set_finished(journal, true, &err));
    assert_true(journal_is_finished(journal) && get_number(journal, "state", 1) == 4);
    assert_true(journal_close(journal, &err));
}

static void test_round_trip(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    round_trip(open_fresh(), "test_journal.run has no static 4, x");
    assert_int_equal(mem_live_count(), blocks);
}

/* In memory it answers as in a file, and each is one of its own; there is no old one to go on with. */
static void test_in_memory(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Error err;
    Journal *other = journal_open(NULL, JOURNAL_NEW, &err),
            *journal = journal_open(NULL, JOURNAL_FORCE, &err);
    assert_true(other && journal);
    put_number(other, "frame", 7, 1);
    round_trip(journal, "the journal in memory has no static 4, x");
    assert_true(count_of(other, "frame") == 1 && journal_close(other, &err));
    assert_true(!journal_open(NULL, JOURNAL_READ, &err) && !journal_open(NULL, JOURNAL_RESUME, &err));
    assert_string_equal(err.text, "the journal in memory: there is no such run");
    assert_int_equal(mem_live_count(), blocks);
}

static bool has_file(const char *path)
{
    return access(path, F_OK) == 0;
}

static void copy_file(const char *from, const char *to)
{
    char command[200];
    snprintf(command, sizeof command, "cp %s %s", from, to);
    assert_int_equal(system(command), 0);
}

/* A journal as a kill leaves it, copied without the log's index, and one that is closed: read from a folder
 * where nothing may be written, which is to say that the reader leaves nothing behind. */
static void test_readers_make_no_files(void **state)
{
    (void)state;
    static const char COPY[] = "test_journal_%41?#copy.run";
    static const char *const endings[] = {"", "-wal", "-shm"};
    char copies[3][64];
    for (int k = 0; k < 3; k++) snprintf(copies[k], sizeof copies[k], "%s%s", COPY, endings[k]);
    Error err;
    Journal *journal = open_fresh();
    put_number(journal, "frame", 0, 7);
    assert_true(journal_flush(journal, &err));
    copy_file(PATH, "'test_journal_%41?#copy.run'");
    copy_file("test_journal.run-wal", "'test_journal_%41?#copy.run-wal'");
    assert_true(journal_close(journal, &err));
    assert_false(has_file("test_journal.run-wal"));
    Journal *reader = journal_open(COPY, JOURNAL_READ, &err);
    if (!reader) fail_msg("%s", err.text);
    assert_true(get_number(reader, "frame", 0) == 7); /* from the log */
    assert_true(journal_close(reader, &err));
    assert_true(has_file(copies[1]) && !has_file(copies[2]));
    unlink(copies[1]);
    copy_file(PATH, "'test_journal_%41?#copy.run'");
    reader = journal_open(COPY, JOURNAL_READ, &err);
    if (!reader) fail_msg("%s", err.text);
    assert_true(get_number(reader, "frame", 0) == 7 && !has_file(copies[1]) && !has_file(copies[2]));
    assert_true(journal_close(reader, &err));
    unlink(COPY);
}

/* What is put in the place of a kind leaves nothing of it, and of others all; both or neither are there. */
static void test_replace(void **state)
{
    (void)state;
    Error err;
    Journal *journal = open_fresh();
    double value = 1;
    Array old[] = {array_float("a", "m", &value, 0, 0, 0), array_float("b", "m", &value, 0, 0, 0)}, got;
    assert_true(journal_put(journal, "final", 0, old, 2, &err) &&
                journal_put(journal, "final", 3, old, 1, &err));
    put_number(journal, "finally", 0, 5);
    value = 2;
    assert_true(journal_replace(journal, "final", 0, old, 1, &err));
    assert_true(journal_get(journal, "final", 0, "a", &got, &err) && *(const double *)got.data == 2);
    array_clear(&got);
    assert_true(journal_find(journal, "final", 0, "b", &got, &err) && !got.data);
    assert_true(journal_find(journal, "final", 3, "a", &got, &err) && !got.data);
    assert_true(get_number(journal, "finally", 0) == 5);
    assert_true(journal_replace(journal, "final", 0, NULL, 0, &err) && count_of(journal, "final") == 0);
    assert_true(journal_close(journal, &err));
}

/* "Not there" and "cannot be read" are two answers. */
static void test_unreadable(void **state)
{
    (void)state;
    Error err;
    Array got;
    bool has = true;
    int count;
    Journal *journal = open_fresh();
    for (int k = 0; k < 200; k++) put_number(journal, "frame", k, k);
    assert_true(journal_close(journal, &err));
    Journal *reader = journal_open(PATH, JOURNAL_READ, &err);
    assert_true(reader && journal_has(reader, "frame", 200, "value", &has, &err) && !has);
    assert_true(journal_has(reader, "frame", 199, "value", &has, &err) && has);
    assert_true(journal_close(reader, &err));
    FILE *file = fopen(PATH, "r+");
    assert_true(file && fseek(file, 2 * 4096, SEEK_SET) == 0); /* the tables' pages follow the first two */
    for (int k = 0; k < 30 * 4096; k++) fputc(0xa5, file);
    fclose(file);
    reader = journal_open(PATH, JOURNAL_READ, &err);
    assert_non_null(reader);
    bool told[] = {journal_has(reader, "frame", 3, "value", &has, &err),
                   journal_find(reader, "frame", 3, "value", &got, &err),
                   journal_count(reader, "frame", &count, &err)};
    for (int k = 0; k < 3; k++) assert_false(told[k]);
    assert_non_null(strstr(err.text, "test_journal.run is damaged"));
    journal_close(reader, &err);
    clean();
}

static void expect_refusal(JournalMode mode, const char *sentence)
{
    Error err;
    Journal *journal = journal_open(PATH, mode, &err);
    assert_null(journal);
    if (!strstr(err.text, sentence)) fail_msg("'%s' lacks '%s'", err.text, sentence);
}

static void test_modes(void **state)
{
    (void)state;
    Error err;
    Journal *journal = open_fresh(), *reader;
    put_number(journal, "meta", 0, 1);
    assert_true(journal_flush(journal, &err));
    reader = journal_open(PATH, JOURNAL_READ, &err); /* while the writer lives */
    assert_non_null(reader);
    assert_true(get_number(reader, "meta", 0) == 1);
    pid_t child = fork();
    if (child == 0)
        _exit(journal_open(PATH, JOURNAL_FORCE, &err) || !strstr(err.text, "another run is writing"));
    int status;
    waitpid(child, &status, 0);
    assert_int_equal(status, 0);
    put_number(journal, "meta", 1, 2);
    assert_true(journal_flush(journal, &err) && get_number(reader, "meta", 1) == 2);
    journal_close(reader, &err);
    assert_true(journal_close(journal, &err));

    expect_refusal(JOURNAL_NEW,
                   "holds an unfinished run: go on with it with --resume, or discard it with --force");
    journal = journal_open(PATH, JOURNAL_RESUME, &err);
    assert_true(journal && !journal_is_finished(journal) && get_number(journal, "meta", 1) == 2);
    assert_true(journal_set_finished(journal, true, &err) && journal_close(journal, &err));
    journal = journal_open(PATH, JOURNAL_READ, &err);
    assert_true(journal && journal_is_finished(journal));
    journal_close(journal, &err);
    journal = journal_open(PATH, JOURNAL_NEW, &err); /* a finished one may go */
    assert_true(journal && count_of(journal, "meta") == 0);
    put_number(journal, "meta", 0, 3);
    assert_true(journal_close(journal, &err));
    journal = journal_open(PATH, JOURNAL_FORCE, &err);
    assert_true(journal && count_of(journal, "meta") == 0);
    assert_true(journal_close(journal, &err));
    clean();
    expect_refusal(JOURNAL_RESUME, "there is no such run");
    fclose(fopen(PATH, "w")); /* killed before its first commit */
    expect_refusal(JOURNAL_RESUME, "is incomplete: its run ended before anything was saved; begin it anew");
    expect_refusal(JOURNAL_READ, "is incomplete: its run ended before anything was saved; begin it anew");
    clean();
}

/* What is no journal is never touched. */
static void test_foreign(void **state)
{
    (void)state;
    static const char text[] =
        "my only copy of the thesis, which is longer than an SQLite header of one hundred bytes, to be sure";
    clean();
    FILE *file = fopen(PATH, "w");
    fputs(text, file);
    fclose(file);
    for (JournalMode mode = JOURNAL_NEW; mode <= JOURNAL_READ; mode++)
        expect_refusal(mode, "is not a journal of slender");
    char back[256] = {0};
    file = fopen(PATH, "r");
    assert_int_equal(fread(back, 1, sizeof back, file), sizeof text - 1);
    fclose(file);
    assert_string_equal(back, text);
    clean();
}

static char *read_all(size_t *size)
{
    FILE *file = fopen(PATH, "rb");
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *bytes = malloc(*size);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

static void write_all(const char *bytes, size_t size)
{
    clean();
    FILE *file = fopen(PATH, "wb");
    fwrite(bytes, 1, size, file);
    fclose(file);
}

/* Flipped bits and truncation are noticed, or harm nothing. */
static void test_damage(void **state)
{
    (void)state;
    enum { UNITS = 20, FLIPS = 300 };
    Error err;
    Random random = random_seed(4);
    Journal *journal = open_fresh();
    for (int k = 0; k < UNITS; k++) put_number(journal, "frame", k, k);
    assert_true(journal_close(journal, &err));
    size_t size;
    int caught = 0;
    char *bytes = read_all(&size);
    for (int k = 0; k < FLIPS; k++) {
        size_t at = (size_t)(random_uniform(&random) * (double)size);
        int bit = 1 << (int)(8 * random_uniform(&random));
        bytes[at] = (char)(bytes[at] ^ bit);
        write_all(bytes, k % 10 ? size : at);
        bytes[at] = (char)(bytes[at] ^ bit);
        journal = journal_open(PATH, JOURNAL_RESUME, &err);
        if (!journal) {
            caught++;
            continue;
        }
        for (int unit = 0; unit < UNITS; unit++) /* it passed the check: every number must be right */
            assert_true(get_number(journal, "frame", unit) == unit);
        journal_close(journal, &err);
    }
    print_message("%d of %d damages caught, the others harmless\n", caught, FLIPS);
    assert_true(caught > FLIPS / 10);
    free(bytes);
    clean();
}

/* A writer that says on a pipe what has been acknowledged. */
static void write_until_killed(int pipe)
{
    Error err;
    Journal *journal = journal_open(PATH, JOURNAL_FORCE, &err);
    double numbers[500];
    for (int k = 0; journal; k++) {
        for (int i = 0; i < 500; i++) numbers[i] = k + i;
        Array array = array_float("numbers", "", numbers, 1, 500, 0);
        if (!journal_put(journal, "frame", k, &array, 1, &err) || !journal_flush(journal, &err)) break;
        if (write(pipe, &k, sizeof k) != sizeof k) break;
    }
    _exit(1);
}

static void test_kill(void **state)
{
    (void)state;
    enum { KILLS = 12 };
    Random random = random_seed(6);
    for (int trial = 0; trial < KILLS; trial++) {
        int ends[2], acknowledged = -1, k;
        clean();
        assert_int_equal(pipe(ends), 0);
        pid_t child = fork();
        if (child == 0) write_until_killed(ends[1]);
        close(ends[1]);
        assert_int_equal(read(ends[0], &acknowledged, sizeof acknowledged), sizeof acknowledged);
        usleep((useconds_t)(30000 * random_uniform(&random)));
        kill(child, SIGKILL);
        while (read(ends[0], &k, sizeof k) == sizeof k) acknowledged = k;
        waitpid(child, NULL, 0);
        close(ends[0]);
        Error err;
        Journal *journal = journal_open(PATH, JOURNAL_RESUME, &err);
        if (!journal) fail_msg("%s", err.text);
        assert_true(count_of(journal, "frame") > acknowledged);
        for (k = 0; k <= acknowledged; k++) {
            Array array;
            assert_true(journal_get(journal, "frame", k, "numbers", &array, &err));
            assert_true(((const double *)array.data)[499] == k + 499);
            array_clear(&array);
        }
        journal_close(journal, &err);
    }
    clean();
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_round_trip),
                                       cmocka_unit_test(test_in_memory),
                                       cmocka_unit_test(test_readers_make_no_files),
                                       cmocka_unit_test(test_replace),
                                       cmocka_unit_test(test_unreadable),
                                       cmocka_unit_test(test_modes),
                                       cmocka_unit_test(test_foreign),
                                       cmocka_unit_test(test_damage),
                                       cmocka_unit_test(test_kill)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
