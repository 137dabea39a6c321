/* The field table: every kind of row, units, defaults, overrides, the way back to text. Sentences about
 * broken scenes are in tests/broken. */
#include "base/memory.h"
#include "io/yaml.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

typedef struct Inner {
    char *name;
    double value;
    char *formula;
} Inner;

typedef struct Outer {
    double length, angle, missing, vector[3], *list, (*rows)[2];
    int count, kind, pair[2], *kinds;
    bool flag;
    char *text, *file, **texts;
    Inner inner, *optional, *entries, *names;
    int list_count, rows_count, kinds_count, texts_count, entries_count, names_count;
} Outer;

static const YamlTable inner_table = {
    .name = "inner",
    .doc = "A number or a formula.",
    .size = sizeof(Inner),
    .fields = (const YamlField[]){
        {YAML_NUMBER(Inner, value), .unit = "Pa", .one_of = 1, .short_form = true, .doc = "the value"},
        {YAML_TEXT(Inner, formula), .one_of = 1, .short_form = true, .doc = "an expression"},
        {0}}};

static const YamlTable outer_table = {
    .name = "scene",
    .doc = "All kinds.",
    .size = sizeof(Outer),
    .fields = (const YamlField[]){
        {YAML_NUMBER(Outer, length), .unit = "m", .range = "(0, inf)", .required = true, .doc = "a length"},
        {YAML_NUMBER(Outer, angle), .unit = "rad", .fallback = "90 deg", .doc = "an angle"},
        {YAML_NUMBER(Outer, missing), .doc = "a number"},
        {YAML_VECTOR(Outer, vector), .unit = "m/s^2", .fallback = "[0, 0, -9.81]", .doc = "three numbers"},
        {YAML_NUMBERS(Outer, list), .unit = "T", .doc = "any numbers"},
        {YAML_ROWS(Outer, rows), .doc = "pairs"},
        {YAML_INTEGER(Outer, count), .range = "[0, 10]", .fallback = "3", .doc = "a count"},
        {YAML_CHOICE(Outer, kind), .choices = YAML_NAMES("hinge", "midedge"), .fallback = "midedge",
         .doc = "a choice"},
        {YAML_INTEGER_VECTOR(Outer, pair), .doc = "two whole numbers"},
        {YAML_CHOICES(Outer, kinds), .choices = YAML_NAMES("one", "two", "three"), .doc = "choices"},
        {YAML_BOOL(Outer, flag), .also = YAML_NAMES("false"), .doc = "a switch"},
        {YAML_TEXT(Outer, text), .doc = "a text"},
        {YAML_FILE(Outer, file), .doc = "a file"},
        {YAML_TEXTS(Outer, texts), .doc = "texts"},
        {YAML_TABLE(Outer, inner, &inner_table), .fallback = "1 kPa", .doc = "a table"},
        {YAML_OPTIONAL(Outer, optional, &inner_table), .doc = "a table that may be absent"},
        {YAML_LIST(Outer, entries, &inner_table), .doc = "tables"},
        {YAML_MAP(Outer, names, &inner_table), .doc = "tables with names"},
        {0}}};

static YamlFile *parse(const char *text)
{
    return yaml_parse("/somewhere/test.yaml", text, strlen(text));
}

static const char full[] =
    "slender: 1\n"
    "length: 1.5 mm\nangle: 0.5\nvector: [1, 2 m/s^2, 3e3 mm/s^2]\nlist: 20 mT\nrows: [[1, 2], [3, 4]]\n"
    "count: 7\nkind: hinge\npair: [1, 2]\nkinds: [two, one]\nflag: true\ntext: 'a \"b\" \\ c'\n"
    "file: mesh.obj\ntexts: [\"x\", y]\ninner: 2 MPa\noptional: \"3*x\"\n"
    "entries: [1, {formula: z}]\nnames: {up: 5 kPa, \"down: x\": {value: 6}}\n";

static void test_kinds(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Outer o;
    YamlFile *file = parse(full);
    if (!yaml_load(file, &outer_table, &o)) fail_msg("%s", yaml_report(file));
    assert_true(o.length == 1.5 * 1e-3 && o.angle == 0.5 && isnan(o.missing));
    assert_true(o.vector[0] == 1 && o.vector[1] == 2 && fabs(o.vector[2] - 3) < 1e-15);
    assert_true(o.list_count == 1 && fabs(o.list[0] - 0.02) < 1e-17);
    assert_true(o.rows_count == 2 && o.rows[1][0] == 3 && o.count == 7 && o.kind == 0 && o.pair[1] == 2);
    assert_true(o.kinds_count == 2 && o.kinds[0] == 1 && o.kinds[1] == 0 && o.flag);
    assert_string_equal(o.text, "a \"b\" \\ c");
    assert_true(strlen(o.file) > strlen("/mesh.obj") && !strcmp(o.file + strlen(o.file) - 9, "/mesh.obj"));
    assert_string_equal(o.texts[1], "y");
    assert_true(o.inner.value == 2e6 && !o.inner.formula);
    assert_string_equal(o.optional->formula, "3*x");
    assert_true(isnan(o.optional->value) && o.entries_count == 2 && o.entries[0].value == 1);
    assert_string_equal(o.entries[1].formula, "z");
    assert_string_equal(o.names[1].name, "down: x");
    assert_true(o.names[0].value == 5e3 && o.names[1].value == 6);
    yaml_clear(&outer_table, &o);
    yaml_destroy(file);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_defaults(void **state)
{
    (void)state;
    Outer o;
    YamlFile *file = parse("{\"slender\": 1, \"length\": 2}"); /* JSON is YAML */
    assert_true(yaml_load(file, &outer_table, &o));
    assert_true(o.length == 2 && fabs(o.angle - M_PI / 2) < 1e-15 && o.vector[2] == -9.81 && o.count == 3 &&
                o.kind == 1);
    assert_true(o.pair[0] == YAML_ABSENT && !o.list && !o.text && !o.optional && !o.entries &&
                o.inner.value == 1000);
    yaml_clear(&outer_table, &o);
    yaml_destroy(file);
}

static void test_round_trip(void **state)
{
    (void)state;
    Outer o, again;
    YamlFile *file = parse(full);
    assert_true(yaml_override(file, "length=0.1234567890123456789"));
    assert_true(yaml_load(file, &outer_table, &o));
    char *text = yaml_write(&outer_table, &o);
    YamlFile *second = parse(text);
    assert_true(yaml_load(second, &outer_table, &again));
    assert_memory_equal(&o.length, &again.length, sizeof(double));
    assert_memory_equal(o.vector, again.vector, sizeof o.vector);
    char *text_again = yaml_write(&outer_table, &again);
    assert_string_equal(text, text_again);
    mem_free(text);
    mem_free(text_again);
    yaml_clear(&outer_table, &o);
    yaml_clear(&outer_table, &again);
    yaml_destroy(file);
    yaml_destroy(second);
}

static void test_units(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double value;
    } good[] = {
        {"1", 1},    {"-2.5e3", -2500}, {"1 m/s^2", 1}, {"1mm/s^2", 1e-3}, {"2 km/h^2", 2000.0 / 3600 / 3600},
        {".5", 0.5}, {"3 cm/s^2", 0.03}};
    static const char *const bad[] = {"1 m", "1 m/s", "1 m/s^2 x", "1e",    "0x10",  "inf",     "nan",
                                      "one", "1,5",   "1 2",       "m/s^2", "1e999", "1 m/s/s", "''"};
    const YamlTable table = {
        .name = "scene",
        .doc = "",
        .size = sizeof(double[3]),
        .fields = (const YamlField[]){{.key = "a", .kind = FIELD_NUMBER, .unit = "m/s^2", .doc = ""}, {0}}};
    double value[3];
    char text[64];
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        snprintf(text, sizeof text, "slender: 1\na: %s\n", good[k].text);
        YamlFile *file = parse(text);
        if (!yaml_load(file, &table, value) || fabs(value[0] - good[k].value) > 1e-15 * fabs(good[k].value))
            fail_msg("%s", good[k].text);
        yaml_destroy(file);
    }
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        snprintf(text, sizeof text, "slender: 1\na: %s\n", bad[k]);
        YamlFile *file = parse(text);
        if (yaml_load(file, &table, value)) fail_msg("%s is taken for %g", bad[k], value[0]);
        assert_int_equal(yaml_error_count(file), 1);
        yaml_destroy(file);
    }
}

static void expect_override(const char *assignment, const char *sentence)
{
    Outer o;
    YamlFile *file = parse(full);
    yaml_override(file, assignment);
    assert_false(yaml_load(file, &outer_table, &o));
    char *report = yaml_report(file);
    assert_string_equal(report, sentence);
    mem_free(report);
    yaml_destroy(file);
}

static void test_overrides(void **state)
{
    (void)state;
    Outer o;
    YamlFile *file = parse(full);
    assert_true(yaml_override(file, "length=2 mm") && yaml_override(file, "inner.formula=x+1") &&
                yaml_override(file, "entries[0]=9"));
    assert_true(yaml_override(file, "entries[2].value=10") && yaml_override(file, "vector=[0, 0, 1]") &&
                yaml_override(file, "names.left=4"));
    if (!yaml_load(file, &outer_table, &o)) fail_msg("%s", yaml_report(file));
    assert_true(o.length == 0.002 && o.entries_count == 3 && o.entries[0].value == 9 &&
                o.entries[2].value == 10 && o.vector[2] == 1);
    assert_true(o.names_count == 3 && !strcmp(o.names[2].name, "left"));
    assert_string_equal(o.inner.formula, "x+1");
    char *where = yaml_where(file, "entries[0]");
    assert_string_equal(where, "--set entries[0]=9");
    mem_free(where);
    yaml_clear(&outer_table, &o);
    yaml_destroy(file);
    expect_override("length=-1", "--set length=-1: length is -1; it must be in (0, inf) m\n");
    expect_override("lenght=1", "--set lenght=1: the scene has no key 'lenght'; did you mean 'length'?\n");
    expect_override("length", "--set length: it must be key=value, e.g. shell.thickness=1mm\n");
    expect_override("entries[9]=1", "--set entries[9]=1: the index is beyond the end of the list\n");
    expect_override("count[0]=1", "--set count[0]=1: count must be a number, not a list\n");
    expect_override("inner={a: 1, a: 2}", "--set inner={a: 1, a: 2}: the key 'a' is there twice\n");
    expect_override(
        "inner={a: 1",
        "--set inner={a: 1: no YAML: did not find expected ',' or '}', while parsing a flow mapping\n");
}

/* What one key sets, no other one sets again, whichever comes first; of one key the last counts. */
static void test_twins(void **state)
{
    (void)state;
    static const struct {
        const char *first, *second, *twin;
    } rows[] = {{"length=1", "length=2", NULL},
                {"inner.value=1", "inner=2", "inner.value"},
                {"inner=1", "inner.value=2", "inner"},
                {"inner={value: 1}", "inner.value=2", "inner"},
                {"inner={value: 1}", "inner={value: 2}", NULL},
                {"entries=[1, 2]", "entries[1]=3", "entries"},
                {"entries[1]=3", "entries=[1, 2]", "entries[1]"},
                {"entries[0]=9", "entries[1]=3", NULL},
                {"names={left: 1}", "names.right=2", NULL},
                {"entries=[1, 2]", "entries[2]=3", NULL}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        YamlFile *file = parse(full);
        assert_true(yaml_override(file, rows[k].first));
        if (yaml_override(file, rows[k].second) != !rows[k].twin) fail_msg("row %zu", k);
        char *report = yaml_report(file), *wanted = NULL;
        if (rows[k].twin)
            wanted = mem_format("--set %s: it and %s say the same: one of them can be set\n", rows[k].second,
                                rows[k].twin);
        assert_string_equal(report, wanted ? wanted : "");
        mem_free(report);
        mem_free(wanted);
        yaml_destroy(file);
    }
}

static void test_difference(void **state)
{
    (void)state;
    static const char *const ignored[] = {"b.c", NULL};
    char *none = yaml_difference("a: 1\nb: {c: 2, d: [1, 2]}\n", "a: 1\nb: {c: 3, d: [1, 2]}\n", ignored);
    assert_null(none);
    char *list = yaml_difference("a: 1\nb: {c: 2, d: [1, 2]}\n", "a: 1\nb: {c: 3, d: [1, 3]}\n", ignored);
    assert_string_equal(list, "b.d[1]");
    char *more = yaml_difference("a: 1\n", "a: 1\ne: 2\n", ignored);
    assert_string_equal(more, "e");
    mem_free(list);
    mem_free(more);
}

static void test_report(void **state)
{
    (void)state;
    Outer o;
    YamlFile *file = parse("slender: 1\nlength: 1\nkind: hing\n");
    assert_false(yaml_load(file, &outer_table, &o));
    char *report = yaml_report(file);
    assert_string_equal(
        report, "/somewhere/test.yaml:3:7: kind must be hinge or midedge, not 'hing'; did you mean 'hinge'?\n"
                "    kind: hing\n"
                "          ^\n");
    mem_free(report);
    assert_false(yaml_refuse(file, "length", "that is %s", "long"));
    int count;
    const YamlError *errors = yaml_errors(file, &count);
    assert_int_equal(count, 2);
    assert_int_equal(errors[0].line, 2);
    assert_string_equal(errors[0].sentence, "length: that is long");
    yaml_destroy(file);
}

/* The schema is JSON, and the manual names every key. */
static void test_manual(void **state)
{
    (void)state;
    char *schema = yaml_schema(&outer_table, "test"), *manual = yaml_manual(&outer_table, "test");
    YamlFile *file = parse(schema);
    assert_int_equal(yaml_error_count(file), 0);
    for (const YamlField *row = outer_table.fields; row->key; row++) {
        char key[64];
        snprintf(key, sizeof key, row->also ? "| `%s`, `%s` |" : "| `%s` |", row->key,
                 row->also ? row->also[0] : "");
        assert_non_null(strstr(manual, key));
        snprintf(key, sizeof key, "\"%s\": {", row->key);
        assert_non_null(strstr(schema, key));
    }
    yaml_check_table(&outer_table);
    yaml_destroy(file);
    mem_free(schema);
    mem_free(manual);
}

static bool has_line(const char *text, const char *line)
{
    const char *at = strstr(text, line);
    return at && (at == text || at[-1] == '\n') && at[strlen(line)] == '\n';
}

/* As --set has them: what a line says is taken by the table. */
static void test_keys(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "length=", "inner=", "inner.value=", "entries[0].formula=", "names=", "kind=hinge", "flag=true"};
    char *keys = yaml_keys(&outer_table);
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) assert_true(has_line(keys, lines[k]));
    assert_null(strstr(keys, "names."));
    for (char *line = strtok(keys, "\n"); line; line = strtok(NULL, "\n")) {
        Outer o;
        if (line[strlen(line) - 1] == '=') continue;
        YamlFile *file = parse(full);
        assert_true(yaml_override(file, line));
        if (!yaml_load(file, &outer_table, &o)) fail_msg("%s: %s", line, yaml_report(file));
        if (!strncmp(line, "flag", 4)) assert_true(o.flag == !strcmp(line, "flag=true"));
        yaml_clear(&outer_table, &o);
        yaml_destroy(file);
    }
    mem_free(keys);
}

static Outer load(const char *text)
{
    Outer o;
    YamlFile *file = parse(text);
    if (!yaml_load(file, &outer_table, &o)) fail_msg("%s", yaml_report(file));
    yaml_destroy(file);
    return o;
}

/* What other programs make of a scene: keys in alphabetical order, numbers in quotes, aliases, another name
 * for a key that is a boolean to them, pairs of surrogates. */
static void test_foreign(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Outer o =
        load("count: '7'\nfalse: \"true\"\nlength: '1.5e-3'\nlist: &id001 ['1', 2 mT]\nslender: 1\n"
             "vector: &v ['0', 0, -9.81]\ninner: '2 MPa'\noptional: &v 5\nentries: [*v, {value: *v}]\n");
    assert_true(o.count == 7 && o.flag && o.length == 1.5e-3 && o.list[0] == 1 && o.vector[2] == -9.81);
    assert_true(o.inner.value == 2e6 && o.entries_count == 2 && o.entries[0].value == 5 &&
                o.entries[1].value == 5);
    char *text = yaml_write(&outer_table, &o);
    assert_non_null(strstr(text, "\n\"flag\": true\n"));
    yaml_clear(&outer_table, &o);
    o = load(text);
    assert_true(o.flag);
    mem_free(text);
    yaml_clear(&outer_table, &o);
    o = load("{\"text\": \"\\ud83e\\uddf2\\/\\\\ud83e\", \"length\": 1, \"slender\": 1}");
    assert_string_equal(o.text, "\xf0\x9f\xa7\xb2/\\ud83e");
    yaml_clear(&outer_table, &o);
    assert_int_equal(mem_live_count(), blocks);
}

/* Windows begins its files with a byte order mark. */
static void test_mark(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    YamlFile *file = yaml_parse("mark.yaml", "\xef\xbb\xbfslender: 2\n", 14);
    Outer outer;
    assert_false(yaml_load(file, &outer_table, &outer));
    char *report = yaml_report(file);
    assert_non_null(strstr(report, "mark.yaml:1:10: "));
    mem_free(report);
    yaml_destroy(file);
    file = yaml_parse("mark.yaml", "\xff\xfes\0:\0", 6);
    report = yaml_report(file);
    assert_string_equal(report, "mark.yaml: the file is UTF-16 text; save it as UTF-8\n");
    mem_free(report);
    yaml_destroy(file);
    assert_int_equal(mem_live_count(), blocks);
}

/* Keys that are used here and not there. */
typedef struct Part {
    char *formula, *names;
    double step, value;
    int solver;
} Part;

typedef struct Job {
    int job;
    Part part, *parts;
    double end;
    int parts_count;
} Job;

static const YamlTable part_table = {
    .name = "part",
    .doc = "A part.",
    .size = sizeof(Part),
    .fields = (const YamlField[]){
        {YAML_NUMBER(Part, value), .one_of = 1, .short_form = true, .doc = "a number"},
        {YAML_TEXT(Part, formula), .one_of = 1, .short_form = true, .doc = "an expression"},
        {YAML_TEXT(Part, names), .when = "formula", .doc = "of a formula"},
        {YAML_NUMBER(Part, step), .unit = "s", .fallback = "1 s",
         .when = "/job: move, stop & !value & solver: one", .otherwise = "nothing moves", .doc = "of time"},
        {YAML_CHOICE(Part, solver), .choices = YAML_NAMES("one", "two"), .fallback = "one",
         .doc = "a choice"},
        {0}}};

static const YamlTable job_table = {
    .name = "scene",
    .doc = "A job.",
    .size = sizeof(Job),
    .fields = (const YamlField[]){{YAML_CHOICE(Job, job), .choices = YAML_NAMES("rest", "move", "stop"),
                                   .required = true, .doc = "what"},
                                  {YAML_TABLE(Job, part, &part_table), .doc = "a part"},
                                  {YAML_LIST(Job, parts, &part_table), .doc = "parts"},
                                  {YAML_NUMBER(Job, end), .when = "part.formula | parts", .doc = "a number"},
                                  {0}}};

static void test_use(void **state)
{
    (void)state;
    static const struct {
        const char *text, *sentence; /* NULL: all is used */
    } cases[] = {
        {"job: move\npart: {formula: a, names: b, step: 2 s}\nend: 1", NULL},
        {"job: rest\npart: {step: 1}", NULL}, /* the default says nothing */
        {"job: rest\npart: {step: 1000 ms}", NULL},
        {"job: rest\npart: x\nend: 1", NULL},
        {"job: rest\nparts: [1]\nend: 1", NULL},
        {"job: rest\npart: {step: 2 s}",
         ":3:8: part.step is not used with `job: rest`, only with move, stop: nothing moves"},
        {"job: move\npart: {value: 1, step: 2 s}",
         ":3:18: part.step is not used beside `value`: nothing moves"},
        {"job: stop\npart: {step: 2 s, solver: two}",
         ":3:8: part.step is not used with `solver: two`, only with one: nothing moves"},
        {"job: move\nparts: [1, {value: 2, names: b}]",
         ":3:23: parts[1].names is not used without `formula`"},
        {"job: move\npart: 1\nend: 1", ":4:1: end is not used without `part.formula | parts`"},
    };
    yaml_check_table(&job_table);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        long blocks = mem_live_count();
        char *text = mem_format("slender: 1\n%s\n", cases[k].text);
        YamlFile *file = parse(text);
        Job job;
        if (!yaml_load(file, &job_table, &job)) fail_msg("%s", yaml_report(file));
        bool used = yaml_check_use(file, &job_table);
        char *report = yaml_report(file);
        if (used != !cases[k].sentence || (!used && !strstr(report, cases[k].sentence)))
            fail_msg("%s\nsays\n%s", text, report);
        mem_free(report);
        mem_free(text);
        yaml_clear(&job_table, &job);
        yaml_destroy(file);
        assert_int_equal(mem_live_count(), blocks);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_kinds),      cmocka_unit_test(test_defaults),
                                       cmocka_unit_test(test_round_trip), cmocka_unit_test(test_units),
                                       cmocka_unit_test(test_overrides),  cmocka_unit_test(test_twins),
                                       cmocka_unit_test(test_difference), cmocka_unit_test(test_report),
                                       cmocka_unit_test(test_mark),       cmocka_unit_test(test_foreign),
                                       cmocka_unit_test(test_manual),     cmocka_unit_test(test_keys),
                                       cmocka_unit_test(test_use)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
