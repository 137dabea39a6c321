/* What all calls have in common: a guard for memory, errors, hosts. */
#include "base/memory.h"
#include "lib/objects.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct Call {
    SlenderStatus (*work)(void *self, Error *err);
    void *self;
    SlenderStatus status;
    Error err;
} Call;

static void do_work(void *self)
{
    Call *call = self;
    call->status = call->work(call->self, &call->err);
}

SlenderStatus lib_call(SlenderStatus (*work)(void *self, Error *err), void *self, SlenderError *err)
{
    Call call = {work, self, SLENDER_NO_MEMORY, {""}};
    guard_call(do_work, &call, &call.err);
    if (!err) return call.status;
    err->status = call.status;
    snprintf(err->text, sizeof err->text, "%s", call.status == SLENDER_DONE ? "" : call.err.text);
    for (char *c = err->text; *c; c++) /* users' words may have lines */
        if ((unsigned char)*c < ' ') *c = ' ';
    return call.status;
}

SlenderStatus lib_refuse(Error *err, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(err->text, sizeof err->text, format, args);
    va_end(args);
    return SLENDER_REFUSED;
}

/* ---- Hosts ---- */

static void step(void *self, int number, int total, const char *detail)
{
    const SlenderHost *host = self;
    host->step(host->self, number, total, detail);
}

static void say(void *self, const char *sentence)
{
    const SlenderHost *host = self;
    host->say(host->self, sentence);
}

static void warn(void *self, const char *sentence)
{
    const SlenderHost *host = self;
    host->warn(host->self, sentence);
}

static bool stop(void *self)
{
    const SlenderHost *host = self;
    return host->stop(host->self) != 0;
}

static void frame(void *self, double time, int points, const double *place)
{
    const SlenderHost *host = self;
    host->frame(host->self, time, points, place);
}

Host lib_host(const SlenderHost *host)
{
    if (!host) return (Host){0};
    return (Host){(void *)host,
                  host->step ? step : NULL,
                  host->say ? say : NULL,
                  host->warn ? warn : NULL,
                  host->stop ? stop : NULL,
                  host->frame ? frame : NULL};
}

/* ---- Texts ---- */

const char *slender_version(void)
{
    return SLENDER_VERSION;
}

static SlenderStatus take_versions(void *self, Error *err)
{
    (void)err;
    *(char **)self = run_versions();
    return SLENDER_DONE;
}

char *slender_versions(void)
{
    char *text = NULL;
    lib_call(take_versions, &text, NULL);
    return text;
}

static SlenderStatus take_schema(void *self, Error *err)
{
    (void)err;
    *(char **)self = yaml_schema(scene_table(), "slender scene");
    return SLENDER_DONE;
}

char *slender_schema(void)
{
    char *text = NULL;
    lib_call(take_schema, &text, NULL);
    return text;
}

void slender_free(char *text)
{
    mem_free(text);
}
