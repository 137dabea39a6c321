#include "sweep/sweep.h"
#include "base/memory.h"
#include "io/path.h"
#include "io/replace.h"
#include "sweep/runs_file.h"
#include <errno.h>
#include <string.h>
#include <unistd.h>

/* ---- The file's keys ---- */

typedef struct VaryKey {
    char *key;
    YamlValue *values;
    int values_count;
} VaryKey;

typedef struct VaryScene {
    bool zip;
    char *file;
    VaryKey *keys;
    int keys_count;
} VaryScene;

typedef struct BestScene {
    char *of;
    bool least;
} BestScene;

typedef struct SweepScene {
    char *scene, **collect;
    VaryScene vary;
    int seeds, collect_count;
    BestScene *best;
} SweepScene;

static const YamlTable key_table = {
    .name = "varied key",
    .doc = "The values of a key of the scene, written as for `--set`: `shell.thickness: [0.5 mm, 1 mm]`.",
    .size = sizeof(VaryKey),
    .fields = (const YamlField[]){{YAML_VALUES(VaryKey, values), .short_form = true, .min_count = 1,
                                   .required = true, .doc = "one for each run, or of all combinations"},
                                  {0}}};

static const YamlTable vary_table = {
    .name = "vary",
    .doc = "What differs from run to run: all combinations of the keys' values, the last key's fastest.",
    .size = sizeof(VaryScene),
    .fields = (const YamlField[]){
        {YAML_BOOL(VaryScene, zip), .one_of = 1,
         .doc = "the keys' first values together, then their second ones, .."},
        {YAML_FILE(VaryScene, file), .one_of = 1,
         .doc = "a CSV file in place of keys: its first line names them, each further one is a run"},
        {YAML_MAP(VaryScene, keys, &key_table), .rest = true, .doc = "any key of the scene"},
        {0}}};

static const YamlTable best_table = {
    .name = "best",
    .doc = "Which run is the best.",
    .size = sizeof(BestScene),
    .fields =
        (const YamlField[]){{YAML_TEXT(BestScene, of), .required = true, .short_form = true,
                             .doc = "path of a number in the results; of several rows, the last one"},
                            {YAML_BOOL(BestScene, least), .doc = "the least is the best, not the largest"},
                            {0}}};

const YamlTable sweep_table = {
    .name = "sweep",
    .doc = "Many runs of one scene: `slender sweep FILE`.",
    .version = "sweep",
    .size = sizeof(SweepScene),
    .fields = (const YamlField[]){
        {YAML_FILE(SweepScene, scene), .required = true, .doc = "the scene, relative to this file"},
        {YAML_TABLE(SweepScene, vary, &vary_table), .doc = "what differs from run to run"},
        {YAML_INTEGER(SweepScene, seeds), .range = "[1, 100000]",
         .doc = "each run so many times, with `design.seed` from 1 on: designs from many random starts"},
        {YAML_TEXTS(SweepScene, collect),
         .doc = "paths in the results that become columns of the table, beside the run's values and status"},
        {YAML_OPTIONAL(SweepScene, best, &best_table), .doc = "which run is the best"},
        {0}}};

/* ---- Keys ---- */

static SweepKey *add_key(Sweep *sweep, const char *name, int count)
{
    sweep->keys =
        mem_resize(sweep->keys, (size_t)sweep->key_count, (size_t)sweep->key_count + 1, sizeof *sweep->keys);
    SweepKey *key = &sweep->keys[sweep->key_count++];
    *key = (SweepKey){.name = mem_text(name), .count = count};
    key->values = mem_alloc((size_t)count, sizeof *key->values);
    return key;
}

static void add_varied(Sweep *sweep, const VaryKey *vary)
{
    SweepKey *key = add_key(sweep, vary->key, vary->values_count);
    for (int i = 0; i < key->count; i++) {
        const YamlValue *value = &vary->values[i];
        key->values[i] = (SweepValue){mem_text(value->text),
                                      mem_format("%s:%d:%d", sweep->path, value->line, value->column)};
    }
}

static void add_listed(Sweep *sweep, const char *path, const RunsFile *list)
{
    for (int k = 0; k < list->columns; k++) {
        SweepKey *key = add_key(sweep, list->cells[k], list->rows);
        for (int i = 0; i < list->rows; i++)
            key->values[i] = (SweepValue){mem_text(list->cells[(i + 1) * list->columns + k]),
                                          mem_format("%s:%d", path, list->line[i + 1])};
    }
}

static bool add_file(Sweep *sweep, YamlFile *file, const VaryScene *vary)
{
    RunsFile list = {0};
    Error err;
    if (vary->keys_count)
        return yaml_refuse(file, "vary.file",
                           "the file lists all keys that differ, and '%s' stands beside it",
                           vary->keys[0].key);
    char *table = mem_format("%s.csv", sweep->name);
    bool ok = !replace_is_same(table, vary->file) ||
              error_set(&err, "%s: the sweep's own table will have this name", vary->file);
    ok = ok && runs_file_read(vary->file, &list, &err);
    mem_free(table);
    if (ok) add_listed(sweep, vary->file, &list);
    runs_file_clear(&list);
    return ok || yaml_refuse(file, "vary.file", "%s", err.text);
}

/* Does the scene have a design, or is one made by what is varied? A scene that cannot be read is told by its runs. */
static bool has_design(const Sweep *sweep, const char *scene)
{
    static const char key[] = "design";
    YamlFile *file = yaml_read(scene);
    bool has = yaml_error_count(file) || yaml_says(file, key);
    yaml_destroy(file);
    for (int k = 0; k < sweep->key_count && !has; k++) has = !strncmp(sweep->keys[k].name, key, strlen(key));
    return has;
}

static bool add_seeds(Sweep *sweep, YamlFile *file, const char *scene, int count)
{
    static const char name[] = "design.seed";
    if (!has_design(sweep, scene))
        return yaml_refuse(file, "seeds",
                           "seeds need a design, and %s has none; another seed is varied like any key",
                           scene);
    for (int k = 0; k < sweep->key_count; k++)
        if (!strcmp(sweep->keys[k].name, name))
            return yaml_refuse(file, "seeds", "%s is varied already", name);
    char *where = yaml_where(file, "seeds");
    SweepKey *key = add_key(sweep, name, count);
    for (int i = 0; i < count; i++) key->values[i] = (SweepValue){mem_format("%d", i + 1), mem_text(where)};
    mem_free(where);
    return true;
}

/* ---- Runs ---- */

/* Keys that go together step together: so many of them from the first one on. The last key steps fastest. */
static bool count_runs(Sweep *sweep, YamlFile *file, int together)
{
    long count = 1;
    for (int k = sweep->key_count - 1; k >= 0; k--) {
        bool same = k + 1 < together;
        sweep->keys[k].stride = same ? sweep->keys[k + 1].stride : (int)count;
        count *= same ? 1 : sweep->keys[k].count;
        if (count > SWEEP_RUNS_MAX) return yaml_refuse(file, "vary", "more than %d runs", SWEEP_RUNS_MAX);
    }
    sweep->run_count = (int)count;
    return true;
}

static bool check_zip(const Sweep *sweep, YamlFile *file)
{
    for (int k = 1; k < sweep->key_count; k++)
        if (sweep->keys[k].count != sweep->keys[0].count)
            return yaml_refuse(file, "vary.zip", "all keys must have as many values, and %s has %d, %s %d",
                               sweep->keys[0].name, sweep->keys[0].count, sweep->keys[k].name,
                               sweep->keys[k].count);
    return true;
}

static bool make_runs(Sweep *sweep, YamlFile *file, const SweepScene *said)
{
    const VaryScene *vary = &said->vary;
    for (int k = 0; k < vary->keys_count; k++) add_varied(sweep, &vary->keys[k]);
    if ((vary->zip && !check_zip(sweep, file)) || (vary->file && !add_file(sweep, file, vary))) return false;
    int together = vary->zip || vary->file ? sweep->key_count : 0;
    if (said->seeds != YAML_ABSENT && !add_seeds(sweep, file, said->scene, said->seeds)) return false;
    if (!sweep->key_count)
        return yaml_refuse(file, "", "nothing is varied: `vary: {shell.thickness: [0.5 mm, 1 mm]}`");
    if (sweep->key_count > SWEEP_KEYS_MAX)
        return yaml_refuse(file, "vary", "%d keys, and %d can be varied", sweep->key_count, SWEEP_KEYS_MAX);
    return count_runs(sweep, file, together);
}

/* ---- Reading ---- */

/* "dir/sweep" of "dir/sweep.yaml". */
static char *default_name(const char *path)
{
    char *folder = replace_folder(path), *base = path_base_name(path);
    char *name = strchr(path, '/') ? mem_format("%s/%s", folder, base) : mem_text(base);
    mem_free(folder);
    mem_free(base);
    return name;
}

static bool is_sweep(YamlFile *file, const char *path)
{
    return yaml_says(file, sweep_table.version) || !yaml_says(file, "slender") ||
           yaml_refuse(file, "slender", "it is a scene, which is one run: slender run %s", path);
}

static bool check_scene(const SweepScene *said, YamlFile *file)
{
    return access(said->scene, R_OK) == 0 ||
           yaml_refuse(file, "scene", "%s: cannot be read: %s", said->scene, strerror(errno));
}

/* Is it made of names, as those of datasets? */
static bool is_path(const char *path)
{
    for (const char *part = path;; part++) {
        size_t length = strcspn(part, "/\n");
        if (!length || (length <= 2 && !strncmp(part, "..", length)) || part[length] == '\n') return false;
        part += length;
        if (!*part) return true;
    }
}

/* Is one of them a group that the other one is in? */
static bool is_within(const char *one, const char *other)
{
    size_t length = strlen(one);
    return !strncmp(one, other, length) && other[length] == '/';
}

/* Are the columns of one of them, "tip.x" or "steps[4]", called like the other one? */
static bool is_part(const char *one, const char *other)
{
    size_t length = strlen(one);
    return !strncmp(one, other, length) && (other[length] == '.' || other[length] == '[');
}

/* Does the table have a column of that name without it? */
static bool is_column(const Sweep *sweep, const char *path)
{
    bool is = !strcmp(path, "run") || !strcmp(path, "best");
    for (int k = 0; k < sweep->key_count && !is; k++) is = !strcmp(path, sweep->keys[k].name);
    return is;
}

/* Paths that no result can have, or no table: known before the first run. */
static bool check_path(const Sweep *sweep, YamlFile *file, const SweepScene *said, const char *path,
                       const char *key)
{
    if (!is_path(path))
        return yaml_refuse(file, key, "'%s' is no path in a result; it is like final/energy/bending", path);
    if (is_column(sweep, path)) return yaml_refuse(file, key, "the table has a column %s of its own", path);
    for (int k = 0; k < said->collect_count; k++) {
        const char *other = said->collect[k];
        if (is_within(other, path) || is_within(path, other))
            return yaml_refuse(file, key, "one of %s and %s is no dataset", other, path);
        if (is_part(other, path)) return yaml_refuse(file, key, "%s is a column of %s already", path, other);
    }
    return true;
}

static bool check_paths(const Sweep *sweep, YamlFile *file, const SweepScene *said)
{
    bool ok = !said->best || check_path(sweep, file, said, said->best->of, "best.of");
    if (ok && said->best && !strcmp(said->best->of, "status"))
        ok = yaml_refuse(file, "best.of",
                         "the status of a run is no number; the best is one of the solutions");
    for (int k = 0; k < said->collect_count; k++) {
        char *key = mem_format("collect[%d]", k);
        ok = check_path(sweep, file, said, said->collect[k], key) && ok;
        mem_free(key);
    }
    return ok;
}

static char *meaning_of(const Sweep *sweep);

static void take(Sweep *sweep, SweepScene *said)
{
    Error unread; /* its reading will say so */
    sweep->scene = mem_text(said->scene);
    file_sum(sweep->scene, &sweep->sum, &unread);
    sweep->collect_count = said->collect_count;
    sweep->collect = mem_alloc((size_t)said->collect_count, sizeof *sweep->collect);
    for (int k = 0; k < said->collect_count; k++) sweep->collect[k] = mem_text(said->collect[k]);
    sweep->meaning = meaning_of(sweep);
    if (said->best) sweep->best = mem_text(said->best->of), sweep->least = said->best->least;
}

bool sweep_read(const char *path, const char *name, Sweep *sweep, char **report)
{
    SweepScene said = {0};
    YamlFile *file = yaml_read(path);
    *sweep = (Sweep){.path = mem_text(path), .name = name ? mem_text(name) : default_name(path)};
    bool ok = is_sweep(file, path) && yaml_load(file, &sweep_table, &said) && check_scene(&said, file) &&
              make_runs(sweep, file, &said) && check_paths(sweep, file, &said);
    if (ok) take(sweep, &said);
    *report = ok ? NULL : yaml_report(file);
    yaml_clear(&sweep_table, &said);
    yaml_destroy(file);
    return ok;
}

void sweep_clear(Sweep *sweep)
{
    for (int k = 0; k < sweep->key_count; k++) {
        SweepKey *key = &sweep->keys[k];
        for (int i = 0; i < key->count; i++) mem_free(key->values[i].text), mem_free(key->values[i].where);
        mem_free(key->values);
        mem_free(key->name);
    }
    for (int k = 0; k < sweep->collect_count; k++) mem_free(sweep->collect[k]);
    mem_free(sweep->collect);
    mem_free(sweep->keys);
    mem_free(sweep->best);
    mem_free(sweep->scene);
    mem_free(sweep->meaning);
    mem_free(sweep->path);
    mem_free(sweep->name);
    *sweep = (Sweep){0};
}

/* ---- Asking ---- */

const SweepValue *sweep_value(const Sweep *sweep, int run, int key)
{
    const SweepKey *of = &sweep->keys[key];
    return &of->values[run / of->stride % of->count];
}

char *sweep_assignment(const Sweep *sweep, int run, int key)
{
    return mem_format("%s=%s", sweep->keys[key].name, sweep_value(sweep, run, key)->text);
}

char *sweep_run_name(const Sweep *sweep, int run)
{
    return mem_format("%s/%04d", sweep->name, run + 1);
}

/* ---- A run's scene ---- */

static const char OUTPUT[] = "output";

/* "dir/plot.gcode" becomes "dir/0001_plot.gcode": else each run would write over the others'. */
static void own_outputs(OutputScene *output, int run)
{
    char **const names[] = {&output->svg,         &output->png,  &output->gcode,
                            &output->gcode_servo, &output->hpgl, &output->plotter};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char **name = names[k], *before = *name;
        if (!before) continue;
        const char *slash = strrchr(before, '/');
        int folder = slash ? (int)(slash + 1 - before) : 0;
        *name = mem_format("%.*s%04d_%s", folder, before, run + 1, before + folder);
        mem_free(before);
    }
}

bool sweep_load(const Sweep *sweep, int run, YamlFile **file, Scene *scene)
{
    *scene = (Scene){0};
    *file = yaml_read(sweep->scene);
    for (int k = 0; k < sweep->key_count; k++) {
        char *assignment = sweep_assignment(sweep, run, k);
        yaml_override(*file, assignment);
        mem_free(assignment);
    }
    bool ok = yaml_load(*file, scene_table(), scene);
    if (ok) own_outputs(&scene->output, run);
    return ok;
}

/* Is it a key of the scene's `output`, or all of it? */
static bool is_output(const char *key)
{
    return strcspn(key, ".[") == strlen(OUTPUT) && !strncmp(key, OUTPUT, strlen(OUTPUT));
}

int sweep_assignments(const Sweep *sweep, int run, char *assignments[SWEEP_ASSIGNMENTS_MAX])
{
    YamlFile *file;
    Scene scene;
    int count = 0;
    for (int k = 0; k < sweep->key_count; k++)
        if (!is_output(sweep->keys[k].name)) assignments[count++] = sweep_assignment(sweep, run, k);
    if (sweep_load(sweep, run, &file, &scene))
        assignments[count++] = yaml_write_key(scene_table(), &scene, OUTPUT);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return count;
}

/* ---- Was it edited? ---- */

/* All keys that differ are set in each run, so that one run tells for all. NULL: it cannot be loaded. */
static char *meaning_of(const Sweep *sweep)
{
    YamlFile *file;
    Scene scene;
    char *text = sweep_load(sweep, 0, &file, &scene) ? yaml_write(scene_table(), &scene) : NULL;
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return text;
}

bool sweep_has_changed(const Sweep *sweep)
{
    Error err;
    FileSum now;
    if (file_sum(sweep->scene, &now, &err) && now.crc == sweep->sum.crc && now.bytes == sweep->sum.bytes)
        return false;
    char *meaning = meaning_of(sweep);
    bool same = meaning && sweep->meaning && !strcmp(meaning, sweep->meaning);
    mem_free(meaning);
    return !same;
}
