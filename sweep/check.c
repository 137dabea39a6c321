#include "sweep/check.h"
#include "base/guard.h"
#include "base/memory.h"
#include "job/outputs.h"
#include "model/model.h"
#include <string.h>

/* Takes the sentence. */
static void add(Problems *problems, char *sentence)
{
    for (int k = 0; k < problems->count; k++)
        if (!strcmp(problems->sentences[k], sentence)) {
            mem_free(sentence);
            return;
        }
    size_t count = (size_t)problems->count++;
    problems->sentences = mem_resize(problems->sentences, count, count + 1, sizeof(char *));
    problems->sentences[count] = sentence;
}

/* Does a sentence begin with the key, or with what the key is in? */
static bool names_key(const char *sentence, const char *key)
{
    return !strncmp(sentence, key, strcspn(key, ".["));
}

/* What is said of an assignment, "--set key=value: ..", is said of the value's place. NULL: it is of none. */
static char *at_value(const Sweep *sweep, int run, const char *sentence)
{
    static const char set[] = "--set ", colon[] = ": ";
    char *placed = NULL;
    for (int k = 0; !placed && k < sweep->key_count; k++) {
        char *assignment = sweep_assignment(sweep, run, k);
        size_t length = strlen(assignment);
        const char *rest = sentence + strlen(set) + length;
        if (!strncmp(sentence, set, strlen(set)) && !strncmp(sentence + strlen(set), assignment, length) &&
            !strncmp(rest, colon, strlen(colon))) {
            const char *said = rest + strlen(colon), *key = sweep->keys[k].name;
            bool named = names_key(said, key);
            placed = mem_format("%s: %s%s%s", sweep_value(sweep, run, k)->where, named ? "" : key,
                                named ? "" : colon, said);
        }
        mem_free(assignment);
    }
    return placed;
}

/* What is said of a place in the scene, which the run's values may have brought about: once, with the first run that has it.
 * Takes the sentence. */
static void add_of_scene(const Sweep *sweep, int run, char *sentence, Problems *problems)
{
    bool told = false;
    for (int k = 0; k < problems->count && !told; k++)
        told = !strncmp(problems->sentences[k], sentence, strlen(sentence));
    if (!told)
        add(problems,
            mem_format("%s; found in run %d, %s", sentence, run + 1, sweep_value(sweep, run, 0)->where));
    mem_free(sentence);
}

static void add_errors(const Sweep *sweep, int run, const YamlFile *file, Problems *problems)
{
    int count;
    const YamlError *errors = yaml_errors(file, &count);
    for (int k = 0; k < count; k++) {
        const YamlError *error = &errors[k];
        char *placed = error->line ? NULL : at_value(sweep, run, error->sentence);
        if (placed)
            add(problems, placed);
        else if (error->line)
            add_of_scene(
                sweep, run,
                mem_format("%s:%d:%d: %s", sweep->scene, error->line, error->column, error->sentence),
                problems);
        else
            add(problems, mem_format("%s: %s", sweep->scene, error->sentence));
    }
}

/* The tables are none of the files that the scene is made of. */
static bool check_tables(const Sweep *sweep, const Scene *scene, Problems *problems)
{
    static const char *const endings[] = {".csv", ".h5"};
    bool ok = true;
    for (size_t k = 0; k < sizeof endings / sizeof *endings; k++) {
        Error err;
        char *table = mem_format("%s%s", sweep->name, endings[k]);
        bool free = outputs_check_source(scene, sweep->scene, table, &err);
        if (!free) add(problems, mem_text(err.text));
        ok = ok && free;
        mem_free(table);
    }
    return ok;
}

static bool check_folders(const Sweep *sweep, int run, const Scene *scene, Problems *problems)
{
    Error err;
    char *name = sweep_run_name(sweep, run), *result = mem_format("%s.vtkhdf", name);
    bool ok = outputs_check_folders(scene, result, &err);
    if (!ok) add(problems, mem_format("%s: %s", sweep->scene, err.text));
    mem_free(name);
    mem_free(result);
    return ok;
}

/* Will nothing be computed? */
static bool is_settled(const RunState *state)
{
    return state->record == RECORD_FINISHED || state->held;
}

static bool check_one(const Sweep *sweep, int run, bool force, RunState *state, Problems *problems)
{
    YamlFile *file;
    Scene scene;
    *state = (RunState){0};
    bool ok = sweep_load(sweep, run, &file, &scene);
    if (ok) *state = state_read(sweep, run, &scene);
    if (ok && record_is_kept(state->record) && !force) {
        add(problems, mem_text(state->wrong.text));
        ok = false;
    } else if (ok && !is_settled(state)) {
        Model *model = model_create(&scene, file);
        ok = model != NULL;
        model_destroy(model);
        ok = ok && check_folders(sweep, run, &scene, problems);
    }
    ok = ok && check_tables(sweep, &scene, problems);
    add_errors(sweep, run, file, problems);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return ok;
}

typedef struct Checking {
    const Sweep *sweep;
    int run;
    bool force, ok;
    RunState *state;
    Problems *problems;
} Checking;

static void check_within(void *self)
{
    Checking *c = self;
    c->ok = check_one(c->sweep, c->run, c->force, c->state, c->problems);
}

/* One run that is too large for this machine leaves what is wrong with the others to be said. */
bool check_run(const Sweep *sweep, int run, bool force, RunState *state, Problems *problems)
{
    Error err;
    Checking c = {.sweep = sweep, .run = run, .force = force, .state = state, .problems = problems};
    if (guard_call(check_within, &c, &err)) return c.ok;
    *state = (RunState){0};
    add(problems, mem_format("%s: run %d: %s", sweep_value(sweep, run, 0)->where, run + 1, err.text));
    return false;
}

void problems_clear(Problems *problems)
{
    for (int k = 0; k < problems->count; k++) mem_free(problems->sentences[k]);
    mem_free(problems->sentences);
    *problems = (Problems){0};
}
