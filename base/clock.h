/* clock.h - monotonic seconds. */
#pragma once

/* Seconds since some fixed moment. */
double clock_seconds(void);

/* CPU seconds of the calling thread. */
double clock_thread_seconds(void);
