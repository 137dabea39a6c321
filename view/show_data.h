/* show_data.h - what the pages of a result have in common: arrays that a page borrows, kept until it is
 * drawn, which frames it shows, and the history of a design. */
#pragma once
#include "io/result.h"
#include "view/show.h"

typedef struct ShowData {
    Result *result;
    bool borrowed; /* the result */
    const ShowDef *def;
    bool motion; /* frames are moments in time */
    bool drawn;  /* all was read: what fails now is the writing */
    int array_count, block_count;
    Array *arrays;
    void **blocks;
} ShowData;

/* Opens the result. False and a sentence where it cannot be read; clear the data in any case. */
bool show_data_open(ShowData *data, const char *result, const ShowDef *def, Error *err);
void show_data_clear(ShowData *data);

/* The same of a result that is open, and the caller's. */
void show_data_borrow(ShowData *data, Result *result, const ShowDef *def);

/* Zeroed memory. */
void *show_block(ShowData *data, size_t count, size_t size);

/* Keeps an array that was read; returns its numbers. */
void *show_keep(ShowData *data, Array array);

/* Places of which only some coordinates are known: the others as the body has them, x[count][3]. What has none stays NaN. */
void show_fill_places(double (*places)[3], const double (*x)[3], int count);

/* A dataset of this many numbers; NULL where there is none. */
void *show_dataset(ShowData *data, const char *path, ArrayType type, size_t count);

/* A text made as by printf. */
char *show_text(ShowData *data, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* How many frames are shown beside or after each other: as asked for, of a motion some moments, never more
 * than there are; 0: the final state. show_frame gives the k-th of them: evenly spread, the first and the
 * last among them. */
int show_frame_count(const ShowData *data);
int show_frame(const ShowData *data, int k);

/* Of so many frames: how many an animation of that length shows, and which is the k-th of `count`. */
int show_moment_count(int frames, double seconds);
int show_moment(int frames, int count, int k);

/* False and a sentence where the result has no such frame. */
bool show_check_frame(const ShowData *data, int frame, Error *err);

/* s; NAN where it is not known, or frames are no moments. */
double show_frame_time(const ShowData *data, int frame);

/* "t = 0.2 s" of a motion, else "frame 3". */
char *show_frame_name(ShowData *data, int frame);

/* The objective of a design over its evaluations; false where there is none, or none is asked for. The chart
 * keeps what it borrows in the data. */
bool show_history(ShowData *data, Chart *chart);
