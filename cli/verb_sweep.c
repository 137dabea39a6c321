/* slender sweep: many runs of one scene, here or by a scheduler, and their table. */
#include "base/memory.h"
#include "cli/progress.h"
#include "cli/say.h"
#include "cli/verb.h"
#include "solve/kernels.h"
#include "sweep/check.h"
#include "sweep/slurm.h"
#include "sweep/table.h"
#include "sweep/work.h"
#include <limits.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SWEEP_HELD = 76, THREADS_MAX = 64 };

typedef struct SweepOptions {
    const char *file, *output;
    int jobs, threads, index;
    bool list, collect, slurm, retry, force, quiet;
    const char *const *sbatch; /* options behind --; ends with NULL */
} SweepOptions;

static const char usage[] =
    "sweep FILE [-o NAME] [--jobs N] [--threads N] [--retry | --force] [--quiet]\n"
    "       slender sweep FILE --list | --index N | --collect | --slurm [-- OPTIONS of sbatch]\n"
    "  Runs a scene many times with other values, each run a `slender run`; NAME/0001.vtkhdf .. are the "
    "results,\n"
    "  NAME.csv and NAME.h5 their table. The same command again goes on: what has finished is kept.\n"
    "  -o NAME      default: the sweep's file without its ending\n"
    "  --jobs N     so many runs side by side; default: as many as there are processors\n"
    "  --threads N  of each run; default: the processors shared out among them\n"
    "  --retry      goes on with the runs that have failed, too\n"
    "  --force      begins them anew, and replaces results of another scene\n"
    "  --quiet      says nothing but errors\n"
    "  --list       the runs, their values and what has become of them\n"
    "  --index N    does one run, from 1 on: for schedulers\n"
    "  --collect    makes the table only\n"
    "  --slurm      submits what is to be computed as a job array";

/* ---- Options ---- */

/* What stands behind -- is not the verb's. */
static int split(int argc, char **argv, const char *const **rest)
{
    static const char *const none[] = {NULL};
    *rest = none;
    for (int k = 1; k < argc; k++)
        if (!strcmp(argv[k], "--")) {
            *rest = (const char *const *)&argv[k + 1];
            return k;
        }
    return argc;
}

static int processors(void)
{
    cpu_set_t set;
    int count = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
    return count < 1 ? 1 : count > THREADS_MAX ? THREADS_MAX : count;
}

/* Is it more than a folder's path: is there a name for files beside others? */
static bool is_name(const char *path)
{
    const char *slash = strrchr(path, '/'), *last = slash ? slash + 1 : path;
    return *last && strcmp(last, ".") != 0 && strcmp(last, "..") != 0;
}

/* What excludes each other; NULL: nothing is wrong. */
static const char *misuse_of(const SweepOptions *o)
{
    if (o->list + o->collect + o->slurm + (o->index > 0) > 1)
        return "one of --list, --index, --collect and --slurm can be given";
    if (o->retry && o->force)
        return "--retry goes on with runs that have failed and --force begins them anew: one of them can be "
               "given";
    if (*o->sbatch && !o->slurm) return "what stands behind -- is for sbatch, with --slurm";
    if (o->output && !is_name(o->output))
        return "-o takes the name of a new folder and of the tables beside it, as results/thickness, and it "
               "has none at its end";
    return NULL;
}

static bool parse(int argc, char **argv, SweepOptions *o, int *code)
{
    const Option options[] = {
        {"output", .letter = 'o', .kind = OPTION_TEXT, .value = &o->output},
        {"jobs", .kind = OPTION_INT, .value = &o->jobs, .least = 1, .most = 1024},
        {"threads", .kind = OPTION_INT, .value = &o->threads, .least = 1, .most = THREADS_MAX},
        {"index", .kind = OPTION_INT, .value = &o->index, .least = 1, .most = SWEEP_RUNS_MAX},
        {"list", .value = &o->list},
        {"collect", .value = &o->collect},
        {"slurm", .value = &o->slurm},
        {"retry", .value = &o->retry},
        {"force", .value = &o->force},
        {"quiet", .value = &o->quiet},
    };
    argc = split(argc, argv, &o->sbatch);
    if (!options_parse(argc, argv, usage, options, sizeof options / sizeof *options, &o->file, code))
        return false;
    const char *misuse = misuse_of(o);
    if (misuse) {
        *code = verb_fail(RUN_USAGE, misuse);
        return false;
    }
    if (o->index) o->jobs = 1;
    if (!o->jobs) o->jobs = processors();
    return true;
}

/* ---- Checks ---- */

static void print_problems(const Problems *problems)
{
    enum { SHOWN = 100 };
    for (int k = 0; k < problems->count && k < SHOWN; k++) say(stderr, "%s", problems->sentences[k]);
    if (problems->count > SHOWN) say(stderr, "and %d more", problems->count - SHOWN);
}

/* Does NAME.csv begin as the sweep's table does? */
static bool has_table(const Sweep *sweep)
{
    char *path = mem_format("%s.csv", sweep->name), *head = mem_format("run,%s", sweep->keys[0].name);
    size_t length = strlen(head);
    char *found = mem_alloc(length + 1, 1);
    FILE *file = fopen(path, "r");
    bool has = file && fread(found, 1, length, file) == length && !memcmp(found, head, length);
    if (file) fclose(file);
    mem_free(found);
    mem_free(head);
    mem_free(path);
    return has;
}

/* Tables of those names are this sweep's where its folder is there, and runs in it or the table of none. */
static bool check_tables(const Sweep *sweep, Error *err)
{
    static const char *const endings[] = {".csv", ".h5"};
    struct stat info;
    bool ok = true, folder = stat(sweep->name, &info) == 0,
         begun = folder && (state_has_runs(sweep) || has_table(sweep));
    if (folder && !S_ISDIR(info.st_mode))
        return error_set(
            err, "'%s' is a file, and the results go to a folder of this name; give another one with -o",
            sweep->name);
    for (size_t k = 0; k < 2 && !begun && ok; k++) {
        char *path = mem_format("%s%s", sweep->name, endings[k]);
        if (access(path, F_OK) == 0)
            ok =
                error_set(err,
                          "'%s' is there, and no table of this sweep, which has not begun; give another name "
                          "with -o, or replace it with --force",
                          path);
        mem_free(path);
    }
    return ok;
}

/* A run that is not to be done is counted as it ended. */
static bool check_one(const Sweep *sweep, const SweepOptions *o, int run, Problems *problems,
                      SweepTally *tally)
{
    RunState state;
    bool right = check_run(sweep, run, o->force, &state, problems),
         next = right && state_next(&state, o->retry, o->force);
    if (right && !next) tally_add(tally, state.code);
    state_clear(&state);
    return next;
}

static bool check_each(const Sweep *sweep, const SweepOptions *o, int *runs, int *count, SweepTally *tally)
{
    Problems problems = {0};
    int left = 0;
    for (int k = 0; k < *count; k++)
        if (check_one(sweep, o, runs[k], &problems, tally)) runs[left++] = runs[k];
    *count = left;
    print_problems(&problems);
    bool ok = problems.count == 0;
    problems_clear(&problems);
    return ok;
}

/* Before the first one starts: leaves of these runs those that are to be done. RUN_DONE, or a code after printing what is
 * wrong, and nothing is left of a sweep that has not begun. */
static int check_runs(const Sweep *sweep, const SweepOptions *o, int *runs, int *count, SweepTally *tally)
{
    Error err;
    bool fresh = access(sweep->name, F_OK) != 0;
    if (!state_make_folder(sweep, &err)) return verb_fail(RUN_CANNOT_WRITE, err.text);
    if (check_each(sweep, o, runs, count, tally)) return RUN_DONE;
    if (fresh) rmdir(sweep->name);
    return RUN_REFUSED;
}

/* ---- What can be done ---- */

/* "1  shell.thickness=1 mm"; the caller frees. */
static char *line_of(const Sweep *sweep, int run)
{
    char *line = mem_format("%d", run + 1);
    for (int k = 0; k < sweep->key_count; k++) {
        char *said = yaml_value_text(sweep_value(sweep, run, k)->text);
        line = mem_join(line, "  ", sweep->keys[k].name);
        line = mem_join(line, "=", said);
        mem_free(said);
    }
    return line;
}

/* Of a scene that cannot be loaded, of what a run would not replace, of a failure; NULL: there is none. */
static const char *reason_of(const YamlFile *file, const RunState *state)
{
    int count;
    const YamlError *errors = yaml_errors(file, &count);
    if (count) return errors[0].sentence;
    return record_is_kept(state->record) ? state->wrong.text : state_is_failed(state) ? state->said : NULL;
}

static int list_runs(const Sweep *sweep)
{
    for (int r = 0; r < sweep->run_count; r++) {
        YamlFile *file;
        Scene scene;
        bool loaded = sweep_load(sweep, r, &file, &scene);
        RunState state = loaded ? state_read(sweep, r, &scene) : (RunState){0};
        char *word = loaded ? state_word(&state, sweep, r) : mem_text("refused"), *line = line_of(sweep, r);
        const char *reason = reason_of(file, &state);
        say(stdout, "%s  %s%s%s", line, word, reason ? ": " : "", reason ? reason : "");
        state_clear(&state);
        mem_free(word);
        mem_free(line);
        yaml_clear(scene_table(), &scene);
        yaml_destroy(file);
    }
    return RUN_DONE;
}

static int collect(const Sweep *sweep, const Host *host)
{
    Error err;
    int best;
    if (!table_collect(sweep, host, &best, &err)) return verb_fail(RUN_CANNOT_WRITE, err.text);
    host_say(host, "table: %s.csv", sweep->name);
    if (best >= 0) host_say(host, "the best is run %d: %s/best.vtkhdf", best + 1, sweep->name);
    if (sweep->best && best < 0)
        host_say(host, "no result that is a solution has a number at %s: none is the best", sweep->best);
    return RUN_DONE;
}

static int code_of(const SweepTally *t)
{
    if (t->interrupted) return RUN_INTERRUPTED;
    return t->failed || t->not_converged ? RUN_NOT_CONVERGED : t->held ? SWEEP_HELD : RUN_DONE;
}

static int run_all(const Sweep *sweep, const SweepOptions *o, const int *runs, int count, SweepTally *t,
                   const Host *host)
{
    Error err;
    int jobs = o->jobs < count ? o->jobs : count, share = count ? processors() / jobs : 1;
    SweepWork work = {.sweep = sweep,
                      .host = host,
                      .jobs = jobs,
                      .threads = o->threads  ? o->threads
                                 : share > 1 ? share
                                             : 1,
                      .retry = o->retry,
                      .force = o->force};
    if (count && !work_run(&work, runs, count, t, &err)) return verb_fail(RUN_CANNOT_WRITE, err.text);
    host_say(host,
             "%d done, %d did not converge, %d failed, %d interrupted or not begun, %d under way elsewhere",
             t->converged, t->not_converged, t->failed, t->interrupted, t->held);
    if (t->interrupted) host_say(host, "all is saved: the same command goes on");
    int table = o->index ? RUN_DONE : collect(sweep, host);
    return table ? table : code_of(t);
}

static int submit(const Sweep *sweep, const SweepOptions *o, const int *runs, int count)
{
    Error err;
    SlurmTally tally;
    bool *todo = mem_alloc((size_t)sweep->run_count, sizeof *todo);
    for (int k = 0; k < count; k++) todo[runs[k]] = true;
    SlurmDef def = {.sweep = sweep, .options = o->sbatch, .retry = o->retry, .force = o->force};
    bool ok = slurm_submit(&def, todo, &tally, &err);
    mem_free(todo);
    if (!ok) return verb_fail(RUN_CANNOT_WRITE, err.text);
    say(stdout, "%d runs submitted, %d are with Slurm already, %d are under way elsewhere, %d have ended",
        tally.submitted, tally.waiting, tally.held,
        sweep->run_count - tally.submitted - tally.waiting - tally.held);
    return RUN_DONE;
}

static int do_runs(const Sweep *sweep, const SweepOptions *o)
{
    Error err;
    SweepTally tally = {0};
    Progress progress = progress_start(o->quiet ? PROGRESS_QUIET : PROGRESS_NORMAL);
    Host host = progress_host(&progress);
    if (o->index > sweep->run_count)
        return verb_fail(RUN_USAGE, "--index is beyond the last run; --list names them");
    if (!o->force && !check_tables(sweep, &err)) return verb_fail(RUN_CANNOT_WRITE, err.text);
    if (o->collect) return collect(sweep, &host);
    int count = o->index ? 1 : sweep->run_count, *runs = mem_alloc((size_t)count, sizeof *runs);
    for (int k = 0; k < count; k++) runs[k] = o->index ? o->index - 1 : k;
    int code = check_runs(sweep, o, runs, &count, &tally);
    if (!code)
        code = o->slurm ? submit(sweep, o, runs, count) : run_all(sweep, o, runs, count, &tally, &host);
    mem_free(runs);
    return code;
}

int verb_sweep(int argc, char **argv)
{
    SweepOptions options = {0};
    Sweep sweep;
    char *report;
    int code;
    if (!parse(argc, argv, &options, &code)) return code;
    if (kernels_reserve(1) < 1) mem_exhausted("OpenBLAS, which works in 128 MB");
    bool ok = sweep_read(options.file, options.output, &sweep, &report);
    if (report) say_lines(stderr, report);
    code = !ok ? RUN_REFUSED : options.list ? list_runs(&sweep) : do_runs(&sweep, &options);
    mem_free(report);
    sweep_clear(&sweep);
    return code;
}
