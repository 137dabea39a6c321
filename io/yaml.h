/* yaml.h - scene files: YAML (or JSON) to a struct and back, through one table of fields.
 *
 * A YamlTable lists the keys of one mapping, one row (YamlField) each. The same rows load a file, fill in
 * defaults, write the effective scene, make the JSON Schema for editors and the manual of all keys, and free
 * the struct. A row is written with a macro that takes the key from the member's name and refuses a member of
 * the wrong type at compile time:
 *
 *     typedef struct BallScene { double center[3], radius; } BallScene;
 *     static const YamlTable ball_table = {
 *         .name = "ball", .doc = "All vertices in a ball.", .size = sizeof(BallScene),
 *         .fields = (const YamlField[]){
 *             {YAML_VECTOR(BallScene, center), .unit = "m", .fallback = "[0, 0, 0]", .doc = "its centre"},
 *             {YAML_NUMBER(BallScene, radius), .unit = "m", .range = "(0, inf)", .required = true,
 *              .doc = "its radius"},
 *             {0}}};
 *
 *     YamlFile *file = yaml_read("scene.yaml");
 *     yaml_override(file, "shell.thickness=1 mm");                      // --set
 *     if (yaml_load(file, scene_table(), &scene) && scene.steps < 1)
 *         yaml_refuse(file, "time.steps", "a trajectory takes at least one step");
 *     if (yaml_error_count(file)) ... yaml_report(file) ...
 *     yaml_clear(scene_table(), &scene);
 *     yaml_destroy(file);
 *
 * Refused input fills the file's list of errors, ALL of them in one go, each with its place and one sentence;
 * nothing in here prints or stops. Every text that a function returns is the caller's: mem_free. */
#pragma once
#include <limits.h>
#include <stdbool.h>
#include <stddef.h>

/* ---- The table ---- */

/* What a row's member is in C, what it is in the scene, and what the member holds when the key is absent
 * without a default. A bool is then false. Lists are pointers that the struct owns, with an int
 * `<member>_count` beside them. */
typedef enum YamlKind {
    FIELD_NUMBER,   /* double, SI units                       1.5 mm               NAN                    */
    FIELD_INTEGER,  /* int                                    12                   YAML_ABSENT            */
    FIELD_BOOL,     /* bool                                   true                 false                  */
    FIELD_TEXT,     /* char *                                 up                   NULL                   */
    FIELD_FILE,     /* char *, made absolute                  star.obj             NULL                   */
    FIELD_CHOICE,   /* int or enum: index in .choices         midedge              -1                     */
    FIELD_NUMBERS,  /* double * and count, or double[n]       [1, 2 mm, 3]         NULL, or [0] = NAN     */
    FIELD_INTEGERS, /* int * and count, or int[n]             [0, 32, 64]          NULL, or [0] = YAML_ABSENT
                     */
    FIELD_TEXTS,    /* char ** and count                      ["x", "2*y"]         NULL                   */
    FIELD_CHOICES,  /* int * and count                        [stability, modes]   NULL                   */
    FIELD_ROWS,     /* double (*)[n] and count                [[0, 0, 1], [1, 0, 0]]  NULL                */
    FIELD_VALUES,   /* YamlValue * and count                  [1 mm, [0, 1], up]   NULL                   */
    FIELD_TABLE,    /* struct inside the struct               {radius: 1 mm}       its own defaults       */
    FIELD_OPTIONAL, /* pointer to a struct                    {radius: 1 mm}       NULL                   */
    FIELD_LIST,     /* struct * and count                     [{..}, {..}]         NULL                   */
    FIELD_MAP,      /* struct * and count, first member       {hub: {..}, flap1: {..}}   NULL             */
                    /*   `char *` = the free key, in order                                                */
} YamlKind;

enum { YAML_ABSENT = INT_MIN };

/* A value of any kind as it is written, on one line: what --set takes; and where. */
typedef struct YamlValue {
    char *text;
    int line, column; /* from 1; 0: not in the file */
} YamlValue;

typedef struct YamlTable YamlTable;

/* The first block is filled by the macros below, the second by hand, as far as it applies. */
typedef struct YamlField {
    const char *key;
    YamlKind kind;
    size_t offset;          /* of the member                                                              */
    size_t count_offset;    /* of `<member>_count`; 0: none                                               */
    size_t size;            /* of a sub-table's struct, bytes                                             */
    int width;              /* numbers in double[n], int[n], or in each row; 0: free                      */
    const YamlTable *table; /* of TABLE, OPTIONAL, LIST, MAP                                              */

    const char *doc;      /* a phrase: "thickness h of the sheet"                                   */
    bool required;        /* the key must be there                                                  */
    int one_of;           /* rows of the table with the same number (1, 2, ...) exclude each other; with
                           * `required` exactly one of them must be there. Their defaults apply when none is. A
                           * bool counts as given when true                                         */
    bool short_form;      /* the table may be written as this row's value alone, where that is no mapping:
                           * `young: 1 MPa` for `young: {value: 1 MPa}`. The first such row that accepts the
                           * value takes it: numbers before formulas                                */
    bool alone;           /* of a LIST: one entry may stand without the list                        */
    bool rest;            /* of a MAP: its names stand in the table itself, beside the other rows   */
    const char *fallback; /* default, as scene text: "1 mm", "[0, 0, 0]", "{every: 1}"; NULL: none  */
    const char *unit;     /* SI unit, any product: "m", "A/m", "N s/m"; NULL: a plain number        */
    const char *range;    /* of each number, SI: "(0, inf)", "[0, 0.5]", "(-inf, 0]"; NULL: any     */
    const char *when; /* where the key is used, NULL: always. Conditions joined by `&`: keys of the same table
                           * of which one is written, "points | arc", or none, "!curve"; or a key that has one of
                           * some values, "solver: pbd". A slash begins a key of the root: "/job: simulate", "!/start".
                           * In braces what there is elsewhere: "!rod {a rod is held by its ends}" */
    const char *otherwise; /* what there is elsewhere, of conditions that do not say: ends the sentence of its
                            * refusal */
    const char *const *choices; /* NULL-terminated: YAML_NAMES("hinge", "midedge")                        */
    int min_count, max_count;   /* of a list's entries; 0: no limit                                       */
    const char *const *also;    /* other names of a key that YAML 1.1 takes for a boolean: what it becomes
                                 * there, and a word that passes through. NULL: none                      */
} YamlField;

struct YamlTable {
    const char *name;        /* of its section in the manual and the schema; unique; of the root: "scene" */
    const char *doc;         /* sentences that open the section                                           */
    size_t size;             /* sizeof the struct                                                         */
    const YamlField *fields; /* ends with {0}                                                             */
    const char *version;     /* of the root: the key whose value is 1, the format's; NULL: "slender"      */
};

#define YAML_NUMBER(S, m)         YAML_FIELD(S, m, FIELD_NUMBER, double)
#define YAML_INTEGER(S, m)        YAML_FIELD(S, m, FIELD_INTEGER, int)
#define YAML_BOOL(S, m)           YAML_FIELD(S, m, FIELD_BOOL, bool)
#define YAML_TEXT(S, m)           YAML_FIELD(S, m, FIELD_TEXT, char *)
#define YAML_FILE(S, m)           YAML_FIELD(S, m, FIELD_FILE, char *)
#define YAML_CHOICE(S, m)         YAML_KEY(m, FIELD_CHOICE), .offset = YAML_TYPED(S, m, int, unsigned)
#define YAML_NUMBERS(S, m)        YAML_FIELD(S, m, FIELD_NUMBERS, double *), YAML_COUNT(S, m)
#define YAML_INTEGERS(S, m)       YAML_FIELD(S, m, FIELD_INTEGERS, int *), YAML_COUNT(S, m)
#define YAML_TEXTS(S, m)          YAML_FIELD(S, m, FIELD_TEXTS, char **), YAML_COUNT(S, m)
#define YAML_VALUES(S, m)         YAML_FIELD(S, m, FIELD_VALUES, YamlValue *), YAML_COUNT(S, m)
#define YAML_CHOICES(S, m)        YAML_FIELD(S, m, FIELD_CHOICES, int *), YAML_COUNT(S, m)
#define YAML_VECTOR(S, m)         YAML_ARRAY(S, m, FIELD_NUMBERS, double) /* double m[n]           */
#define YAML_INTEGER_VECTOR(S, m) YAML_ARRAY(S, m, FIELD_INTEGERS, int)   /* int m[n]              */
#define YAML_ROWS(S, m)                                                   /* double (*m)[n]; int m_count */  \
    YAML_FIELD(S, m, FIELD_ROWS, double(*)[YAML_WIDTH(S, *YAML_MEMBER(S, m), double)]),                      \
        .width = YAML_WIDTH(S, *YAML_MEMBER(S, m), double), YAML_COUNT(S, m)
#define YAML_TABLE(S, m, t)    /* T m  */ YAML_SUB(S, m, FIELD_TABLE, YAML_MEMBER(S, m), t)
#define YAML_OPTIONAL(S, m, t) /* T *m */ YAML_SUB(S, m, FIELD_OPTIONAL, *YAML_MEMBER(S, m), t)
#define YAML_LIST(S, m, t)     YAML_SUB(S, m, FIELD_LIST, *YAML_MEMBER(S, m), t), YAML_COUNT(S, m)
#define YAML_MAP(S, m, t)      YAML_SUB(S, m, FIELD_MAP, *YAML_MEMBER(S, m), t), YAML_COUNT(S, m)
#define YAML_NAMES(...)        ((const char *const[]){__VA_ARGS__, NULL})

/* Parts of the macros above. _Generic is an error where the member has another type than the kind needs. */
#define YAML_MEMBER(S, m)           ((S *)0)->m
#define YAML_WIDTH(S, member, type) (sizeof(member) / sizeof(type))
#define YAML_KEY(m, k)              .key = #m, .kind = k
#define YAML_TYPED(S, m, t1, t2)    _Generic(YAML_MEMBER(S, m), t1 : offsetof(S, m), t2 : offsetof(S, m))
#define YAML_FIELD(S, m, k, type)   YAML_KEY(m, k), .offset = _Generic(YAML_MEMBER(S, m), type : offsetof(S, m))
#define YAML_COUNT(S, m)            .count_offset = _Generic(YAML_MEMBER(S, m##_count), int : offsetof(S, m##_count))
#define YAML_ARRAY(S, m, k, type)                                                                            \
    YAML_KEY(m, k), .width = YAML_WIDTH(S, YAML_MEMBER(S, m), type),                                         \
                    .offset = _Generic(&YAML_MEMBER(S, m), type(*)[YAML_WIDTH(S, YAML_MEMBER(S, m), type)]   \
                                       : offsetof(S, m))
#define YAML_SUB(S, m, k, member, t)                                                                         \
    YAML_KEY(m, k), .offset = offsetof(S, m), .size = sizeof(member), .table = t

/* ---- Reading ---- */

/* A scene's text and node tree, and what is wrong with it. */
typedef struct YamlFile YamlFile;

typedef struct YamlError {
    int line, column; /* from 1, in characters; 0: no place in the file (unreadable, --set) */
    char *sentence;   /* what is wrong, what is allowed */
} YamlError;

/* Reads a file, or a text already in memory (path: for messages and for the paths in the scene). Always gives
 * a YamlFile; what is wrong is in its errors. Aliases are copies of what their anchors stand for, of up to
 * 100 000 values in all. Refused: more than 64 MiB, 32 levels or 4 million values, tags, merge keys, several
 * documents, NULs, invalid UTF-8, duplicate keys. */
YamlFile *yaml_read(const char *path);
YamlFile *yaml_parse(const char *path, const char *text, size_t length);

/* The number that a text says in that unit, as the value of a key would; false where it says none. */
bool yaml_number(const char *text, const char *unit, double *value);
void yaml_destroy(YamlFile *file);

/* Sets one value before loading: "shell.mesh.n=7", "fix[0].ball.radius=1 mm", "gravity=[0, 0, -9.81]".
 * Mappings on the way are made; an index may be one beyond the end, to append. Of one key the last one counts; what another
 * key has set is not set again: that is an error. Errors begin with "--set shell.mesh.n=7: ". */
bool yaml_override(YamlFile *file, const char *assignment);

/* Fills the table's struct, defaults included. The file must have the key `slender: 1` (YamlTable.version), which no
 * table lists. The order of keys means nothing, and a number or boolean in quotes is one. Paths are taken relative
 * to the scene file. False if the file has any error; the struct is then empty (zeroed). */
bool yaml_load(YamlFile *file, const YamlTable *table, void *scene);

/* Of a file that was loaded: refuses every key that is written where nothing uses it (YamlField.when), unless
 * it says no more than its default. */
bool yaml_check_use(YamlFile *file, const YamlTable *table);

/* The number that a text is, with a unit or not, in SI; false: it is none. */
bool yaml_quantity(const char *text, double *value);

/* A value of any kind as YamlValue.text has it, without comments; NULL: it is none. */
char *yaml_value_line(const char *text);

/* What a value says: a scalar without its quotes, all else on one line; what is none, as it is. */
char *yaml_value_text(const char *text);

/* The shortest text that reads back bit by bit. */
void number_format(double value, char text[40]);

/* Frees what the struct owns, by the same table, and zeroes it. (libyaml already has a yaml_free.) */
void yaml_clear(const YamlTable *table, void *scene);

/* The first file that the scene names for which the answer is yes; NULL: there is none. Borrowed. */
const char *yaml_find_file(const YamlTable *table, const void *scene,
                           bool (*is)(const char *file, const char *other), const char *other);

/* ---- Errors ---- */

/* Adds an error of the caller's at a key ("shell.mesh.file", "fix[2]", "" for the root), or at the nearest
 * key above it that is written in the file. Returns false. */
bool yaml_refuse(YamlFile *file, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Does the file itself, or --set, say it? */
bool yaml_says(const YamlFile *file, const char *key);

/* Where a key is written: "scene.yaml:7:14", or "--set shell.young=2" if it was set so. */
char *yaml_where(const YamlFile *file, const char *key);

/* The errors by line and column, 100 at most; yaml_error_count counts all. Borrowed until the next call. */
int yaml_error_count(const YamlFile *file);
const YamlError *yaml_errors(const YamlFile *file, int *count);

/* The key that stands at a place in the text, or whose value does: "fix[2].axes"; "" for none. */
char *yaml_key_at(const YamlFile *file, int line, int column);

/* There are no errors any more: what follows is told anew. */
void yaml_forget_errors(YamlFile *file);

/* All errors as text: for each "file:line:column: sentence", the source line and a caret. */
char *yaml_report(const YamlFile *file);

/* ---- Writing ---- */

/* The effective scene: every key with its value, defaults filled in, in SI units without suffix. Loading it
 * gives the same struct bit by bit. */
char *yaml_write(const YamlTable *table, const void *scene);

/* What it says of one of the table's keys, as --set has it: "shell=..", in several lines perhaps. */
char *yaml_write_key(const YamlTable *table, const void *scene, const char *key);

/* The first key in which two effective scenes differ ("shell.young.value"), or NULL. Keys at or below one of
 * `ignored` (NULL-terminated: {"output", "time.steps", NULL}; may be NULL) do not count. */
char *yaml_difference(const char *scene, const char *other, const char *const *ignored);

/* The number that an effective scene has at a key; false: there is none. */
bool yaml_number_at(const char *scene, const char *key, double *value);

/* Visits every file that the struct names: its key as above ("cases.up.target.file") and its absolute path. */
void yaml_files(const YamlTable *table, const void *scene,
                void (*visit)(void *self, const char *key, const char *path), void *self);

/* The unit of a key's numbers, "m" of "fix[0].ball.radius", in its table's words; "" where they are plain, or there is no
 * such key. A table that may be written as one value alone has that value's. */
const char *yaml_unit(const YamlTable *table, const char *key);

/* JSON Schema (draft-07), for editors that complete and check scenes. */
char *yaml_schema(const YamlTable *table, const char *title);

/* The manual of all keys, Markdown: one section per table. */
char *yaml_manual(const YamlTable *table, const char *title);

/* All keys as --set has them, a line each: "shell.thickness=", one for each word that may be its value, "job=design", of a
 * list those of its first entry, "fix[0].ball.radius="; of a mapping with names its own alone. */
char *yaml_keys(const YamlTable *table);

/* For the tests of a table: asserts that its defaults, ranges, units and sub-tables are sound. A FIELD_TABLE
 * that is not required must load from nothing; a table must not contain itself. */
void yaml_check_table(const YamlTable *table);
