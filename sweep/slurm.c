#include "sweep/slurm.h"
#include "base/memory.h"
#include "io/lookup.h"
#include "io/path.h"
#include "io/program.h"
#include "io/safe_file.h"
#include "io/text.h"
#include "sweep/lock.h"
#include "sweep/state.h"
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct Submission {
    const SlurmDef *def;
    char folder[PATH_MAX]; /* of the results, absolute */
    char *name;            /* of the jobs, without +OFFSET */
    int lock, block;       /* tasks of an array: 1 to block */
    bool *waiting, *todo;  /* [runs] Slurm has it; it is to be submitted */
    SlurmTally *tally;
} Submission;

/* ---- Slurm's programs ---- */

/* Runs one to its end, even where the submitter is killed: the lock is its own, too. *said: what it printed; the caller
 * frees. */
static bool ask(const Submission *s, const char *const *arguments, char **said, Error *err)
{
    pid_t process;
    int status = 0;
    char *log = mem_format("%s/slurm.log", s->folder), line[400], buffer[4096];
    int failed = program_start(arguments, log, s->lock, &process);
    while (!failed && waitpid(process, &status, 0) < 0)
        if (errno != EINTR) failed = errno;
    program_last_line(log, line, sizeof line);
    Text text = {0};
    text_add(&text, "%s", "");
    FILE *file = fopen(log, "r");
    while (file && fgets(buffer, sizeof buffer, file)) text_add(&text, "%s", buffer);
    if (file) fclose(file);
    *said = text.text;
    mem_free(log);
    if (failed) return error_set(err, "Slurm's %s cannot be run: %s", arguments[0], strerror(failed));
    return status == 0 || error_set(err, "Slurm's %s failed: %s", arguments[0], line);
}

/* Task numbers of arrays are below MaxArraySize. */
static bool read_block(Submission *s, Error *err)
{
    static const char *const arguments[] = {"scontrol", "show", "config", NULL};
    static const char key[] = "MaxArraySize";
    char *said;
    bool ok = ask(s, arguments, &said, err);
    const char *at = ok ? strstr(said, key) : NULL, *equal = at ? strchr(at, '=') : NULL;
    int size = equal ? atoi(equal + 1) : 0;
    if (ok && size < 2) ok = error_set(err, "Slurm takes no job arrays here: its %s is %d", key, size);
    s->block = size - 1;
    mem_free(said);
    return ok;
}

/* "NAME+0,NAME+1000": all names that jobs of the sweep may have; the caller frees. */
static char *all_names(const Submission *s)
{
    Text text = {0};
    for (int offset = 0; offset < s->def->sweep->run_count; offset += s->block)
        text_add(&text, "%s%s+%d", offset ? "," : "--name=", s->name, offset);
    return text.text;
}

static bool read_waiting(Submission *s, Error *err)
{
    char *names = all_names(s), *said, *rest = NULL;
    const char *arguments[] = {"squeue", "--me", "--noheader", "--array", names, "--format=%j %K", NULL};
    bool ok = ask(s, arguments, &said, err);
    for (char *line = ok ? strtok_r(said, "\n", &rest) : NULL; line; line = strtok_r(NULL, "\n", &rest)) {
        int offset, task;
        const char *plus = strrchr(line, '+');
        if (!plus || sscanf(plus, "+%d %d", &offset, &task) != 2) continue;
        int run = offset + task - 1;
        if (run >= 0 && run < s->def->sweep->run_count) s->waiting[run] = true;
    }
    mem_free(said);
    mem_free(names);
    return ok;
}

/* What has left the queue before Slurm was asked has ended by now: a look at the results before would not tell. */
static void choose(Submission *s, const bool *wanted)
{
    const SlurmDef *def = s->def;
    for (int r = 0; r < def->sweep->run_count; r++) {
        RunState state;
        s->tally->waiting += s->waiting[r];
        if (!wanted[r] || s->waiting[r]) continue;
        bool next = state_look(def->sweep, r, def->retry, def->force, &state) != NULL;
        s->tally->held += state.held;
        s->todo[r] = next && !state.held;
        state_clear(&state);
    }
}

/* ---- Submitting ---- */

/* Within single quotes of a shell. */
static void add_shell(Text *text, const char *word)
{
    text_add(text, "'");
    for (; *word; word++) text_add(text, *word == '\'' ? "'\\''" : "%c", *word);
    text_add(text, "'");
}

/* The caller frees. */
static bool write_job(const Submission *s, char **path, Error *err)
{
    char program[PATH_MAX] = "", file[PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length < 0 || !realpath(s->def->sweep->path, file))
        return error_set(err, "%s: cannot be found: %s", s->def->sweep->path, strerror(errno));
    Text text = {0};
    text_add(
        &text,
        "#!/bin/sh\n# One run of a sweep, for Slurm: the number of a run is the offset ($1) and the task's.\n"
        "#SBATCH --requeue --open-mode=append --signal=B:TERM@60\nexec ");
    add_shell(&text, program);
    text_add(&text, " sweep ");
    add_shell(&text, file);
    text_add(&text, " -o ");
    add_shell(&text, s->folder);
    text_add(&text, " --index $(($1 + SLURM_ARRAY_TASK_ID)) --threads \"${SLURM_CPUS_ON_NODE:-1}\"%s\n",
             s->def->force   ? " --force"
             : s->def->retry ? " --retry"
                             : "");
    *path = mem_format("%s/job.sh", s->folder);
    bool ok = safe_file_write(*path, text.text, text.length, false, err);
    mem_free(text.text);
    return ok;
}

/* "1-7,9"; NULL: none. The caller frees. */
static char *task_list(const Submission *s, int offset, int *count)
{
    Text text = {0};
    *count = 0;
    for (int t = 1; t <= s->block && offset + t <= s->def->sweep->run_count; t++) {
        int from = t;
        while (t <= s->block && offset + t <= s->def->sweep->run_count && s->todo[offset + t - 1]) t++;
        if (t == from) continue;
        text_add(&text, *count ? ",%d" : "%d", from);
        if (t - 1 > from) text_add(&text, "-%d", t - 1);
        *count += t - from;
    }
    return text.text;
}

static bool submit_array(const Submission *s, const char *job, const char *tasks, int offset, Error *err)
{
    enum { OWN = 7 }; /* arguments, and the NULL that ends them */
    size_t given = 0, count = 0;
    while (s->def->options[given]) given++;
    const char **arguments = mem_alloc(given + OWN, sizeof *arguments);
    char *name = mem_format("--job-name=%s+%d", s->name, offset), *array = mem_format("--array=%s", tasks),
         *output = mem_format("--output=%s/slurm-%%A.log", s->folder), *first = mem_format("%d", offset),
         *said;
    arguments[count++] = "sbatch";
    arguments[count++] = output;
    for (size_t k = 0; k < given; k++) arguments[count++] = s->def->options[k];
    arguments[count++] = name;
    arguments[count++] = array;
    arguments[count++] = job;
    arguments[count++] = first;
    arguments[count] = NULL;
    bool ok = ask(s, arguments, &said, err);
    mem_free(arguments);
    mem_free(said);
    mem_free(name);
    mem_free(array);
    mem_free(output);
    mem_free(first);
    return ok;
}

static bool submit_all(Submission *s, const bool *wanted, Error *err)
{
    char *job = NULL;
    bool ok = read_block(s, err) && read_waiting(s, err) && write_job(s, &job, err);
    if (ok) choose(s, wanted);
    for (int offset = 0; ok && offset < s->def->sweep->run_count; offset += s->block) {
        int count;
        char *tasks = task_list(s, offset, &count);
        ok = !count || submit_array(s, job, tasks, offset, err);
        if (ok) s->tally->submitted += count;
        mem_free(tasks);
    }
    mem_free(job);
    return ok;
}

/* Takes the lock of submitters. */
static bool begin(Submission *s, Error *err)
{
    const char *name = s->def->sweep->name;
    bool held;
    if (!realpath(name, s->folder)) return error_set(err, "%s: cannot be found: %s", name, strerror(errno));
    char *lock = mem_format("%s/submit.lock", s->folder), *base = path_base_name(s->folder);
    for (char *c = base; *c; c++)
        if (!isalnum((unsigned char)*c)) *c = '_'; /* names stand in lists, and before a + */
    s->lock = lock_take(lock, &held, err);
    if (held) error_set(err, "%s: another submitter is at work", s->folder);
    s->name = mem_format("slender-%s-%08x", base, (unsigned)lookup_hash(0, s->folder, strlen(s->folder)));
    s->waiting = mem_alloc((size_t)s->def->sweep->run_count, sizeof *s->waiting);
    s->todo = mem_alloc((size_t)s->def->sweep->run_count, sizeof *s->todo);
    mem_free(lock);
    mem_free(base);
    return s->lock >= 0;
}

bool slurm_submit(const SlurmDef *def, const bool *todo, SlurmTally *tally, Error *err)
{
    Submission s = {.def = def, .lock = -1, .tally = tally};
    *tally = (SlurmTally){0};
    bool ok = begin(&s, err) && submit_all(&s, todo, err);
    if (s.lock >= 0) close(s.lock);
    mem_free(s.waiting);
    mem_free(s.todo);
    mem_free(s.name);
    return ok;
}
