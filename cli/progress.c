#include "cli/progress.h"
#include "base/clock.h"
#include "base/memory.h"
#include "base/plain.h"
#include "cli/say.h"
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

static volatile sig_atomic_t interrupted;
static struct timespec first_time;

/* One that comes within a second is the first one again: `timeout`, schedulers and terminals send it to a process and to its
 * group. */
static void interrupt(int signal_number)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (!interrupted) first_time = now;
    bool again = now.tv_sec + 1e-9 * now.tv_nsec > first_time.tv_sec + 1e-9 * first_time.tv_nsec + 1;
    if (interrupted && again) {
        signal(signal_number, SIG_DFL);
        raise(signal_number);
    }
    interrupted = 1;
}

Progress progress_start(ProgressMode mode)
{
    struct sigaction action = {.sa_handler = interrupt, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    return (Progress){
        .mode = mode, .terminal = isatty(STDOUT_FILENO) != 0, .started = clock_seconds(), .shown = -1};
}

static bool is_interrupted(void *self)
{
    (void)self;
    return interrupted != 0;
}

/* Seconds left if steps go on as the last ones did; NAN before the first one. A run that is resumed has not made its first
 * steps, and repeats others in no time. */
static double seconds_left(Progress *progress, double now, int step, int total)
{
    const double memory = 0.9;
    bool first = progress->step == 0;
    if (step > progress->step) {
        double pace = first ? now - progress->started : (now - progress->stepped) / (step - progress->step);
        progress->pace = first ? pace : memory * progress->pace + (1 - memory) * pace;
        progress->step = step, progress->stepped = now;
    }
    return progress->step == 0 ? NAN : progress->pace * (total - step);
}

/* ", about 20 s left", or nothing where that is not known, or at the end; the caller frees. */
static char *left_text(ProgressMode mode, double seconds)
{
    const double minute = 60, hour = 3600;
    if (isnan(seconds)) return mem_text("");
    if (mode == PROGRESS_JSON) return mem_format(" \"left\": %.3g,", seconds);
    if (seconds <= 0) return mem_text("");
    if (seconds < 2 * minute) return mem_format(", about %.0f s left", ceil(seconds));
    return seconds < 2 * hour ? mem_format(", about %.0f min left", seconds / minute)
                              : mem_format(", about %.1f h left", seconds / hour);
}

static void show_bar(int step, int total)
{
    enum { WIDTH = 24 };
    int filled = total > 0 ? step * WIDTH / total : 0;
    char bar[WIDTH + 1];
    for (int i = 0; i < WIDTH; i++) bar[i] = i < filled ? '#' : '.';
    bar[WIDTH] = 0;
    printf("\r\033[K[%s] ", bar);
}

/* As JSON or as plain text; the caller frees. */
static char *shown_text(const Progress *progress, const char *text)
{
    return progress->mode == PROGRESS_JSON ? plain_json(text) : plain_text(text, "");
}

static void show_step(void *self, int step, int total, const char *text)
{
    Progress *progress = self;
    double now = clock_seconds(), seconds = now - progress->started, pause = progress->terminal ? 0.1 : 2;
    double left = seconds_left(progress, now, step, total);
    bool last = step >= total;
    if (!last && progress->shown >= 0 && now - progress->shown < pause) return;
    progress->shown = now;
    char *detail = shown_text(progress, text), *until = left_text(progress->mode, left);
    if (progress->mode == PROGRESS_JSON)
        printf("{\"step\": %d, \"of\": %d, \"seconds\": %.3f,%s \"detail\": \"%s\"}\n", step, total, seconds,
               until, detail);
    else {
        if (progress->terminal) show_bar(step, total);
        printf("%d/%d  %.1f s%s  %s%s", step, total, seconds, until, detail,
               progress->terminal && !last ? "" : "\n");
    }
    mem_free(detail);
    mem_free(until);
    fflush(stdout);
}

static void show_line(void *self, const char *sentence)
{
    Progress *progress = self;
    char *line = shown_text(progress, sentence);
    if (progress->mode == PROGRESS_JSON)
        printf("{\"seconds\": %.3f, \"say\": \"%s\"}\n", clock_seconds() - progress->started, line);
    else
        printf("%s%s\n", progress->terminal ? "\r\033[K" : "", line);
    mem_free(line);
    fflush(stdout);
}

static void show_warning(void *self, const char *sentence)
{
    progress_tell(((Progress *)self)->mode, "warning", sentence);
    say(stderr, "warning: %s", sentence);
}

Host progress_host(Progress *progress)
{
    Host host = {.self = progress, .warn = show_warning, .stop = is_interrupted};
    if (progress->mode != PROGRESS_QUIET) host.step = show_step, host.say = show_line;
    return host;
}

void progress_tell(ProgressMode mode, const char *kind, const char *sentence)
{
    if (mode != PROGRESS_JSON) return;
    char *json = plain_json(sentence);
    printf("{\"%s\": \"%s\"}\n", kind, json);
    mem_free(json);
    fflush(stdout);
}
