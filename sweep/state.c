#include "sweep/state.h"
#include "base/memory.h"
#include "io/safe_file.h"
#include "io/result.h"
#include "sweep/lock.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char *file_of(const Sweep *sweep, int run, const char *ending)
{
    return mem_join(sweep_run_name(sweep, run), ending, "");
}

/* "3: words". */
static void read_end(const char *path, RunState *state)
{
    char line[600] = "", *end;
    FILE *file = fopen(path, "r");
    state->code = -1;
    if (!file) return;
    if (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = 0;
        long code = strtol(line, &end, 10);
        if (end > line) state->code = (int)code;
        if (*end == ':') state->said = mem_text(end + 1 + (end[1] == ' '));
    }
    fclose(file);
}

static bool is_bare(const Sweep *sweep, int run)
{
    char *journal = file_of(sweep, run, ".run"), *result = file_of(sweep, run, ".vtkhdf");
    bool bare = access(journal, F_OK) != 0 && access(result, F_OK) != 0;
    mem_free(journal);
    mem_free(result);
    return bare;
}

RunState state_read(const Sweep *sweep, int run, const Scene *scene)
{
    RunState state = {0};
    char *name = sweep_run_name(sweep, run), *end = file_of(sweep, run, ".end"),
         *lock = file_of(sweep, run, ".lock");
    state.record = record_state(scene, name, &state.wrong);
    state.bare = is_bare(sweep, run);
    state.held = lock_is_held(lock);
    read_end(end, &state);
    mem_free(name);
    mem_free(end);
    mem_free(lock);
    return state;
}

void state_clear(RunState *state)
{
    mem_free(state->said);
    state->said = NULL;
}

bool state_is_failed(const RunState *state)
{
    return state->code > RUN_NOT_CONVERGED && !record_is_kept(state->record);
}

const char *state_next(const RunState *state, bool retry, bool force)
{
    bool failed = state_is_failed(state);
    if (record_is_kept(state->record) || (failed && force)) return force ? "--force" : NULL;
    if (failed && !retry) return NULL;
    if (state->record == RECORD_FINISHED && !failed) return state->code < 0 ? "--resume" : NULL;
    if (state->record == RECORD_SHORT) return "--resume";
    return state->record == RECORD_UNFINISHED ? "--resume" : state->bare ? "--force" : "--quiet";
}

const char *state_look(const Sweep *sweep, int run, bool retry, bool force, RunState *state)
{
    YamlFile *file;
    Scene scene;
    bool ok = sweep_load(sweep, run, &file, &scene);
    *state = ok ? state_read(sweep, run, &scene) : (RunState){.code = RUN_REFUSED};
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return ok ? state_next(state, retry, force) : NULL;
}

static char *result_word(const Sweep *sweep, int run)
{
    Array status;
    char *path = file_of(sweep, run, ".vtkhdf"), *word;
    Result *result = result_open(path, NULL);
    bool has = result && result_read(result, "slender/status", &status, NULL);
    word = mem_text(has ? status.data : "absent");
    if (has) array_clear(&status);
    result_close(result);
    mem_free(path);
    return word;
}

char *state_word(const RunState *state, const Sweep *sweep, int run)
{
    if (state->held) return mem_text("running");
    if (record_is_kept(state->record)) return mem_text(state->record == RECORD_OTHER ? "changed" : "damaged");
    if (state_is_failed(state)) return mem_format("failed: %d", state->code);
    if (state->record == RECORD_SHORT) return mem_text("shorter");
    if (state->record == RECORD_FINISHED) return result_word(sweep, run);
    return mem_text(state->record == RECORD_UNFINISHED ? "interrupted" : "absent");
}

bool state_has_runs(const Sweep *sweep)
{
    static const char *const endings[] = {".end", ".lock", ".run", ".vtkhdf"};
    bool has = false;
    for (int run = 0; run < sweep->run_count && !has; run++)
        for (size_t k = 0; k < sizeof endings / sizeof *endings && !has; k++) {
            char *path = file_of(sweep, run, endings[k]);
            has = access(path, F_OK) == 0;
            mem_free(path);
        }
    return has;
}

bool state_make_folder(const Sweep *sweep, Error *err)
{
    return mkdir(sweep->name, 0777) == 0 || errno == EEXIST ||
           error_set(err, "%s: cannot be made: %s", sweep->name, strerror(errno));
}

void state_put_begin(const Sweep *sweep, int run)
{
    char *path = file_of(sweep, run, ".end");
    unlink(path);
    mem_free(path);
}

bool state_put_end(const Sweep *sweep, int run, int code, const char *said, Error *err)
{
    char *path = file_of(sweep, run, ".end");
    char *text = said && *said ? mem_format("%d: %s\n", code, said) : mem_format("%d\n", code);
    bool ok = safe_file_write(path, text, strlen(text), false, err);
    mem_free(path);
    mem_free(text);
    return ok;
}
