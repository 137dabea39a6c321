/* The table of a sweep's keys, and what is read through it: free keys beside others, values of any kind. */
#include "base/memory.h"
#include "sweep/cells.h"
#include "sweep/check.h"
#include "sweep/lock.h"
#include "sweep/runs_file.h"
#include "sweep/table.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

#define NAME "test_sweep_run"
#include "tests/run_fixture.h"

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void test_table(void **state)
{
    (void)state;
    yaml_check_table(&sweep_table);
    char *schema = yaml_schema(&sweep_table, "slender sweep"), *manual = yaml_manual(&sweep_table, "Sweeps");
    assert_non_null(strstr(schema, "\"sweep\": {\"description\": \"the format's version\", \"const\": 1}"));
    assert_non_null(strstr(schema, "\"additionalProperties\": {\"$ref\": \"#/definitions/varied key\"}"));
    assert_null(strstr(schema, "\"slender\": {"));
    assert_non_null(strstr(manual, "| `zip` | true or false |"));
    mem_free(schema);
    mem_free(manual);
}

/* What is read is written so that it is read as the same again. */
static void test_again(void **state)
{
    (void)state;
    static const char text[] =
        "sweep: 1\nscene: /x.yaml\nvary: {zip: true, a.b: [1 mm, -x, '- y', \"a: b\", [0, 1 mT], "
        "{k: [1], \"l m\": ''}], c: [true, \"it's\"]}\n";
    char *written[2];
    void *scene = mem_alloc(1, sweep_table.size);
    for (int k = 0; k < 2; k++) {
        const char *from = k ? written[0] : text;
        YamlFile *file = yaml_parse("sweep.yaml", from, strlen(from));
        bool ok = yaml_load(file, &sweep_table, scene);
        if (!ok) fail_msg("%s", yaml_report(file));
        written[k] = yaml_write(&sweep_table, scene);
        yaml_clear(&sweep_table, scene);
        yaml_destroy(file);
    }
    assert_string_equal(written[0], written[1]);
    assert_non_null(strstr(written[0], "[0, 1 mT]"));
    mem_free(written[0]);
    mem_free(written[1]);
    mem_free(scene);
}

/* The last key fastest; keys of a zip together, seeds within them. */
static void test_order(void **state)
{
    (void)state;
    static const struct {
        const char *vary, *runs;
    } rows[] = {
        {"vary: {a: [1, 2], b: [x, y, z]}\n", "1x 1y 1z 2x 2y 2z "},
        {"vary: {zip: true, a: [1, 2], b: [x, y]}\n", "1x 2y "},
        {"vary: {zip: true, a: [1, 2], b: [x, y]}\nseeds: 2\n", "1x1 1x2 2y1 2y2 "},
        {"seeds: 3\n", "1 2 3 "},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        Sweep sweep;
        char *report,
            runs[100] = "",
            *text = mem_format("sweep: 1\nscene: " SOURCE_DIR "/scenes/letter_a.yaml\n%s", rows[k].vary);
        write_file("test_sweep.yaml", text);
        if (!sweep_read("test_sweep.yaml", NULL, &sweep, &report)) fail_msg("%s", report);
        for (int r = 0; r < sweep.run_count; r++) {
            for (int i = 0; i < sweep.key_count; i++) strcat(runs, sweep_value(&sweep, r, i)->text);
            strcat(runs, " ");
        }
        assert_string_equal(runs, rows[k].runs);
        assert_string_equal(sweep.name, "test_sweep");
        sweep_clear(&sweep);
        mem_free(text);
    }
    unlink("test_sweep.yaml");
}

static void test_quantities(void **state)
{
    (void)state;
    static const struct {
        const char *text, *cells;
    } rows[] = {{"1 mm", "0.001"},
                {"[0, 0, 10 mT]", "0 0 0.01"},
                {"2.5 kg/m^3", "2.5"},
                {"up", "up"},
                {"[a, 1]", "[a, 1]"},
                {"[[1, 2], [3, 4]]", "[[1, 2], [3, 4]]"},
                {"1 mm * x", "1 mm * x"},
                {"\"../s/m.obj\"", "../s/m.obj"},
                {"\"1 \xc2\xb5m\"", "1e-06"},
                {"[0, \"1 \xc2\xb5T\"]", "0 1e-06"},
                {"1 mm # thin", "0.001"},
                {"'it''s'", "it's"},
                {"[1", "[1"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        Cells cells = cells_of_value(rows[k].text);
        char *all = mem_text("");
        for (int i = 0; i < cells_count(&cells); i++) {
            char *shown = cells.text ? mem_text(cells.text) : mem_format("%g", cells.numbers[i]);
            all = mem_join(all, i ? " " : "", shown);
            mem_free(shown);
        }
        assert_string_equal(all, rows[k].cells);
        mem_free(all);
        cells_clear(&cells);
    }
}

/* What runs have of unequal counts: columns up to 64 numbers; of more one block, each run's numbers in their own rows. */
static void test_columns(void **state)
{
    (void)state;
    double few[] = {1, 2, 3, 4}, many[66];
    for (int i = 0; i < 66; i++) many[i] = i;
    const Cells narrow[] = {{.rows = 2, .width = 2, .numbers = few}, {.rows = 1, .width = 1, .numbers = few}},
                wide[] = {{.rows = 22, .width = 3, .numbers = many},
                          {.rows = 2, .width = 2, .numbers = few},
                          {.text = "none"}};
    Columns columns = {.rows = 2};
    columns_add_cells(&columns, "few", narrow);
    assert_int_equal(columns.count, 4);
    assert_string_equal(columns.columns[1].name, "few[1]");
    assert_string_equal(columns.columns[1].cells[0], "2");
    assert_null(columns.columns[1].cells[1]);
    columns_clear(&columns);
    columns.rows = 3;
    columns_add_cells(&columns, "many", wide);
    const Column *block = columns.columns;
    assert_int_equal(columns.count, 1);
    assert_int_equal(block->rows, 22);
    assert_int_equal(block->width, 3);
    assert_memory_equal(block->numbers, many, sizeof many);
    for (int i = 66; i < 198; i++) {
        int row = (i - 66) / 3, place = i % 3;
        if (row < 2 && place < 2)
            assert_true(block->numbers[i] == few[2 * row + place]);
        else
            assert_true(isnan(block->numbers[i]));
    }
    columns_clear(&columns);
}

/* Of a number, of a table's short form, within lists and below names; none of what has none. */
static void test_units(void **state)
{
    (void)state;
    static const char *const rows[][2] = {{"shell.thickness", "m"},
                                          {"shell.thickness.value", "m"},
                                          {"shell.gravity", "m/s^2"},
                                          {"shell.gravity[2]", "m/s^2"},
                                          {"flux_density", "T"},
                                          {"fix[0].ball.radius", "m"},
                                          {"cases[1].flux_density", "T"},
                                          {"probes.tip", ""},
                                          {"shell.poisson", ""},
                                          {"shell.thickness.none", ""},
                                          {"shell.young.value.none", ""},
                                          {"none.thickness", ""},
                                          {"job", ""},
                                          {"shell[", ""},
                                          {"", ""}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        assert_string_equal(yaml_unit(scene_table(), rows[k][0]), rows[k][1]);
}

static void test_runs_file(void **state)
{
    (void)state;
    RunsFile list;
    Error err;
    write_file("test_sweep.csv", "\xef\xbb\xbf# runs\na , \"b\"\r\n\n 1 mm,\"[0, \"\"1\"\"]\" \n2,3\n");
    if (!runs_file_read("test_sweep.csv", &list, &err)) fail_msg("%s", err.text);
    const char *const cells[] = {"a", "b", "1 mm", "[0, \"1\"]", "2", "3"};
    assert_int_equal(list.rows, 2);
    assert_int_equal(list.columns, 2);
    for (int i = 0; i < 6; i++) assert_string_equal(list.cells[i], cells[i]);
    assert_int_equal(list.line[2], 5);
    runs_file_clear(&list);
    static const char *const wrong[] = {"a,b\n1\n",
                                        "a,b\n1,2,3\n",
                                        "a,b\n1,\n",
                                        "a\n\"1\n",
                                        "a\n\"1\"2\n",
                                        "a\n",
                                        "",
                                        "a,b,a\n1,2,3\n",
                                        "\xff\xfe"
                                        "a\n1\n"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        write_file("test_sweep.csv", wrong[k]);
        if (runs_file_read("test_sweep.csv", &list, &err)) fail_msg("'%s' is read", wrong[k]);
        runs_file_clear(&list);
    }
    unlink("test_sweep.csv");
}

/* Another open file is another holder, in one process, too. */
static void test_lock(void **state)
{
    (void)state;
    Error err;
    bool held;
    assert_false(lock_is_held("test_sweep.lock"));
    int first = lock_take("test_sweep.lock", &held, &err);
    assert_true(first >= 0 && !held);
    assert_true(lock_is_held("test_sweep.lock"));
    assert_true(lock_take("test_sweep.lock", &held, &err) < 0 && held);
    close(first);
    assert_false(lock_is_held("test_sweep.lock"));
    assert_true(lock_take("no/such/folder/lock", &held, &err) < 0 && !held);
    unlink("test_sweep.lock");
}

static void test_next(void **state)
{
    (void)state;
    static const struct {
        RecordState record;
        int code;
        const char *usual, *retry, *force;
        bool bare;
    } rows[] = {
        {RECORD_ABSENT, -1, "--force", "--force", "--force", true},
        {RECORD_ABSENT, 3, NULL, "--force", "--force", true},
        {RECORD_ABSENT, -1, "--quiet", "--quiet", "--quiet", false},
        {RECORD_ABSENT, 3, NULL, "--quiet", "--force", false},
        {RECORD_UNFINISHED, -1, "--resume", "--resume", "--resume", false},
        {RECORD_UNFINISHED, 137, NULL, "--resume", "--force", false},
        {RECORD_SHORT, 0, "--resume", "--resume", "--resume", false},
        {RECORD_SHORT, 3, NULL, "--resume", "--force", false},
        {RECORD_FINISHED, 0, NULL, NULL, NULL, false},
        {RECORD_FINISHED, 1, NULL, NULL, NULL, false},
        {RECORD_FINISHED, 4, NULL, "--quiet", "--force", false},
        {RECORD_FINISHED, -1, "--resume", "--resume", "--resume", false},
        {RECORD_OTHER, 0, NULL, NULL, "--force", false},
        {RECORD_DAMAGED, 0, NULL, NULL, "--force", false},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        RunState at = {.record = rows[k].record, .code = rows[k].code, .bare = rows[k].bare};
        const char *next[] = {state_next(&at, false, false), state_next(&at, true, false),
                              state_next(&at, false, true)},
                   *wanted[] = {rows[k].usual, rows[k].retry, rows[k].force};
        for (int i = 0; i < 3; i++)
            if ((next[i] == NULL) != (wanted[i] == NULL) || (next[i] && strcmp(next[i], wanted[i])))
                fail_msg("row %zu, %d: %s", k, i, next[i] ? next[i] : "nothing");
    }
}

/* Of what has a row for each stage the last one is collected, of other arrays all. */
static void test_rows(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        int width, rows;
    } arrays[] = {{"probes/tip", 3, 3}, {"stages/energy/bending", 1, 3}, {"design/gravity", 3, 1}};
    Error err;
    Result *result = run_text(
        mem_text("slender: 1\njob: equilibrium\nshell:\n  mesh: {shape: sheet, size: [40 mm, 20 mm], "
                 "cells: [4, 2]}\n  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n"
                 "  magnetization: [1.0e+4, 0, 0]\nfix: [{group: root, clamp: true}]\n"
                 "probes: {tip: {group: tip}}\n"
                 "sequence: {flux_density: {from: [0, 0, 0], to: [0, 0, 1 mT], count: 3}}\n"));
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        Cells cells = {0};
        char *path = mem_format("slender/%s", arrays[k].path);
        Array all = read_all(result, path);
        int width = arrays[k].width, last = width * (arrays[k].rows - 1);
        if (!cells_read(result, arrays[k].path, &cells, &err)) fail_msg("%s", err.text);
        assert_int_equal(array_count(&all), last + width);
        assert_int_equal(cells_count(&cells), width);
        for (int i = 0; i < width; i++) assert_true(cells.numbers[i] == ((const double *)all.data)[last + i]);
        cells_clear(&cells);
        array_clear(&all);
        mem_free(path);
    }
    result_close(result);
    remove_run(state);
}

/* Of runs that are not there; a table that the scene is made of is refused. */
static void test_absent(void **state)
{
    (void)state;
    static const char text[] =
        "sweep: 1\nscene: " SOURCE_DIR "/scenes/hexagram_motion.yaml\nvary: {shell.thickness: [1 mm, "
        "2 Q]}\nbest: {of: final/objective}\n";
    Sweep sweep;
    Error err;
    Problems problems = {0};
    char *report, line[200];
    int best;
    write_file("test_absent.yaml", text);
    if (!sweep_read("test_absent.yaml", NULL, &sweep, &report)) fail_msg("%s", report);
    for (int r = 0; r < 2; r++) {
        RunState at;
        assert_true(check_run(&sweep, r, false, &at, &problems) == (r == 0));
        state_clear(&at);
    }
    assert_int_equal(problems.count, 1);
    assert_non_null(
        strstr(problems.sentences[0], "test_absent.yaml:3:32: shell.thickness.value must be a number in m"));
    problems_clear(&problems);
    Host host = {0};
    mkdir(sweep.name, 0777);
    if (!table_collect(&sweep, &host, &best, &err)) fail_msg("%s", err.text);
    assert_int_equal(best, -1);
    FILE *file = fopen("test_absent.csv", "r");
    const char *const lines[] = {"run,shell.thickness,status,final/objective,best\n", "1,1 mm,absent,,0\n",
                                 "2,2 Q,refused,,0\n"};
    for (int k = 0; k < 3; k++) assert_string_equal(fgets(line, sizeof line, file), lines[k]);
    fclose(file);
    mem_free(sweep.name);
    sweep.name = mem_text(SOURCE_DIR "/scenes/hexagram_magnetization");
    RunState at;
    assert_false(check_run(&sweep, 0, true, &at, &problems));
    assert_non_null(strstr(problems.sentences[0], "the scene is made of it"));
    state_clear(&at);
    problems_clear(&problems);
    sweep_clear(&sweep);
    rmdir("test_absent");
    unlink("test_absent.yaml"), unlink("test_absent.csv"), unlink("test_absent.h5");
}

/* Nothing is left, of what is refused either. */
static int check_blocks(void **state)
{
    (void)state;
    return mem_live_count() != 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(test_table, check_blocks),
                                       cmocka_unit_test_teardown(test_again, check_blocks),
                                       cmocka_unit_test_teardown(test_order, check_blocks),
                                       cmocka_unit_test_teardown(test_quantities, check_blocks),
                                       cmocka_unit_test_teardown(test_columns, check_blocks),
                                       cmocka_unit_test_teardown(test_units, check_blocks),
                                       cmocka_unit_test_teardown(test_runs_file, check_blocks),
                                       cmocka_unit_test_teardown(test_lock, check_blocks),
                                       cmocka_unit_test_teardown(test_next, check_blocks),
                                       cmocka_unit_test_teardown(test_rows, check_blocks),
                                       cmocka_unit_test_teardown(test_absent, check_blocks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
