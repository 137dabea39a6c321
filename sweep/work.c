#include "sweep/work.h"
#include "base/memory.h"
#include "io/program.h"
#include "sweep/lock.h"
#include "sweep/state.h"
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* A run under way; run < 0: none. */
typedef struct Task {
    int run, lock;
    pid_t process;
} Task;

typedef struct Working {
    const SweepWork *work;
    Task *tasks; /* [jobs] */
    int active, done, total;
    int *held, held_count; /* runs that another process was at, to be looked at again */
    bool last;             /* for the last time */
    bool stopping, halted; /* those under way are to end, and no further one is begun */
    SweepTally *tally;
    Error *err;
} Working;

void tally_add(SweepTally *tally, int code)
{
    if (code == RUN_DONE)
        tally->converged++;
    else if (code == RUN_NOT_CONVERGED)
        tally->not_converged++;
    else if (code == RUN_INTERRUPTED)
        tally->interrupted++;
    else
        tally->failed++;
}

static void count(Working *w, int run, int code, const char *what)
{
    tally_add(w->tally, code);
    host_step(w->work->host, ++w->done, w->total, "run %d %s", run + 1, what);
}

/* ---- The start of a run ---- */

static int spawn(const SweepWork *work, int run, const char *mode, int lock, pid_t *process)
{
    const Sweep *sweep = work->sweep;
    enum { FIXED = 9 };
    char *name = sweep_run_name(sweep, run), *log = mem_format("%s.log", name),
         *threads = mem_format("%d", work->threads), *assignments[SWEEP_ASSIGNMENTS_MAX];
    const char *arguments[FIXED + 2 * SWEEP_ASSIGNMENTS_MAX + 1] = {
        "/proc/self/exe", "run", sweep->scene, "-o", name, "--no-picture", "--threads", threads, mode};
    int count = sweep_assignments(sweep, run, assignments);
    for (int k = 0; k < count; k++) {
        arguments[FIXED + 2 * k] = "--set";
        arguments[FIXED + 2 * k + 1] = assignments[k];
    }
    int failed = program_start(arguments, log, lock, process);
    for (int k = 0; k < count; k++) mem_free(assignments[k]);
    mem_free(name);
    mem_free(log);
    mem_free(threads);
    return failed;
}

/* The option to begin it with; NULL: another process has done it meanwhile, with *code. */
static const char *next_of(const SweepWork *work, int run, int *code)
{
    RunState state;
    const char *mode = state_look(work->sweep, run, work->retry, work->force, &state);
    if (mode && state.record == RECORD_SHORT)
        host_say(work->host, "run %d goes on: it was shorter than the scene says now", run + 1);
    *code = record_is_kept(state.record) ? RUN_REFUSED : state.code;
    state_clear(&state);
    return mode;
}

/* False where no process can be made. */
static bool start_locked(Working *w, Task *task)
{
    int code, failed = 0;
    const char *mode = next_of(w->work, task->run, &code);
    if (mode) {
        state_put_begin(w->work->sweep, task->run);
        failed = spawn(w->work, task->run, mode, task->lock, &task->process);
    } else {
        count(w, task->run, code, code == RUN_REFUSED ? "is refused now" : "was done elsewhere");
    }
    if (mode && !failed) return w->active++, true;
    close(task->lock);
    task->run = -1;
    return !failed || error_set(w->err, "no process can be started: %s", strerror(failed));
}

/* Another process is at it: by the end of all others it may have ended. */
static void set_aside(Working *w, int run)
{
    if (!w->last) {
        w->held[w->held_count++] = run;
        return;
    }
    w->tally->held++;
    host_step(w->work->host, ++w->done, w->total, "run %d is under way elsewhere", run + 1);
}

static bool start(Working *w, int run)
{
    Task *task = w->tasks;
    while (task->run >= 0) task++;
    char *name = sweep_run_name(w->work->sweep, run), *lock = mem_format("%s.lock", name);
    bool held;
    task->lock = lock_take(lock, &held, w->err);
    mem_free(name);
    mem_free(lock);
    if (held) return set_aside(w, run), true;
    task->run = task->lock >= 0 ? run : -1;
    return task->lock >= 0 && start_locked(w, task);
}

/* ---- The end of one ---- */

static void say_end(Working *w, int run, int code, const char *said)
{
    if (code > RUN_NOT_CONVERGED && code != RUN_INTERRUPTED)
        host_say(w->work->host, "run %d has failed with code %d%s%s", run + 1, code, *said ? ": " : "", said);
    count(w, run, code,
          code == RUN_DONE            ? "done"
          : code == RUN_NOT_CONVERGED ? "did not converge"
          : code == RUN_INTERRUPTED   ? "interrupted"
                                      : "failed");
}

/* A run that was stopped with the sweep has not ended. */
static void finish(Working *w, Task *task, int status)
{
    enum { SIGNALLED = 128 };
    int code = WIFSIGNALED(status) ? SIGNALLED + WTERMSIG(status) : WEXITSTATUS(status);
    if (WIFSIGNALED(status) && w->stopping) code = RUN_INTERRUPTED;
    char said[400] = "", *name = sweep_run_name(w->work->sweep, task->run), *log = mem_format("%s.log", name);
    Error unwritten;
    bool failed = code > RUN_NOT_CONVERGED && code != RUN_INTERRUPTED;
    if (WIFSIGNALED(status))
        snprintf(said, sizeof said, "ended by signal %d, %s", WTERMSIG(status), strsignal(WTERMSIG(status)));
    else if (failed)
        program_last_line(log, said, sizeof said);
    if (code != RUN_INTERRUPTED && !state_put_end(w->work->sweep, task->run, code, said, &unwritten))
        host_warn(w->work->host, "%s", unwritten.text);
    say_end(w, task->run, code, said);
    close(task->lock);
    task->run = -1;
    w->active--;
    mem_free(name);
    mem_free(log);
}

static void wait_for_some(Working *w)
{
    const struct timespec pause = {.tv_nsec = 5000000};
    bool any = false;
    for (int k = 0; k < w->work->jobs; k++) {
        int status;
        Task *task = &w->tasks[k];
        if (task->run < 0 || waitpid(task->process, &status, WNOHANG) != task->process) continue;
        finish(w, task, status);
        any = true;
    }
    if (!any) nanosleep(&pause, NULL);
}

/* Each saves and ends, as by a Ctrl-C of its own. */
static void stop(Working *w)
{
    w->stopping = w->halted = true;
    for (int k = 0; k < w->work->jobs; k++)
        if (w->tasks[k].run >= 0) kill(w->tasks[k].process, SIGINT);
}

/* Runs of one sweep are of one scene. */
static bool may_begin(Working *w)
{
    const Sweep *sweep = w->work->sweep;
    w->halted = sweep_has_changed(sweep);
    if (w->halted)
        host_warn(w->work->host, "%s has changed since the sweep began: no further run is begun",
                  sweep->scene);
    return !w->halted;
}

/* Until all of these have ended or are set aside, or the sweep is stopped. */
static bool do_all(Working *w, const int *runs, int count)
{
    bool ok = true;
    for (int next = 0; w->active || (next < count && ok && !w->halted);) {
        if (!w->stopping && (!ok || host_stops(w->work->host))) stop(w);
        if (w->halted || next == count || w->active == w->work->jobs) {
            if (w->active) wait_for_some(w);
        } else if (may_begin(w)) {
            ok = start(w, runs[next++]);
        }
    }
    return ok;
}

bool work_run(const SweepWork *work, const int *runs, int total, SweepTally *tally, Error *err)
{
    Working w = {.work = work, .total = total, .tally = tally, .err = err};
    w.tasks = mem_alloc((size_t)work->jobs, sizeof *w.tasks);
    for (int k = 0; k < work->jobs; k++) w.tasks[k].run = -1;
    w.held = mem_alloc((size_t)total, sizeof *w.held);
    bool ok = do_all(&w, runs, total);
    w.last = true;
    ok = ok && do_all(&w, w.held, w.held_count);
    tally->interrupted += total - w.done; /* those that were not begun */
    mem_free(w.held);
    mem_free(w.tasks);
    return ok;
}
