/* host.h - whoever runs a job: what a job tells it, and when it asks it to stop. Jobs print nothing and know no
 * terminal. */
#pragma once
#include <stdbool.h>

/* All may be NULL. Called from the thread that runs the job. */
typedef struct Host {
    void *self;

    /* A step of `total` is done; `detail` says what it brought ("F 0.02 F0"). */
    void (*step)(void *self, int step, int total, const char *detail);

    /* A sentence that stays; a warning is one that should not be missed. */
    void (*say)(void *self, const char *sentence);
    void (*warn)(void *self, const char *sentence);

    /* Asked often, from any thread: true when the job shall save and stop. */
    bool (*stop)(void *self);

    /* A frame has been stored, place[count][3] in m. */
    void (*frame)(void *self, double time, int count, const double *place);
} Host;

void host_step(const Host *host, int step, int total, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void host_say(const Host *host, const char *format, ...) __attribute__((format(printf, 2, 3)));
void host_warn(const Host *host, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool host_stops(const Host *host);
