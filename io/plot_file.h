/* plot_file.h - drawings of lines as files for pen plotters: SVG, G-code, HPGL; and how long plotting takes.
 *
 * A plot is curves by layer, a layer what one pen draws. Lengths are mm, as in the files: x right, y down
 * from the paper's top left corner. Curves are drawn in their order; nothing is sorted, cut or joined here.
 * Equal plots give equal bytes. Files are replaced as a whole or not at all. */
#pragma once
#include "base/error.h"
#include "base/vec3.h"
#include "io/colormap.h"
#include <stddef.h>

/* Curve k has the points [start[k]] to [start[k+1] - 1]: 3n + 1 control points of n >= 1 cubic Bezier curves
 * end to end. */
typedef struct PlotLayer {
    const char *name; /* "black"; borrowed by writers */
    Color color;
    bool opaque; /* hides what is below; else that shines through */
    double pen;  /* width of the line, mm */
    int count;
    int *start;   /* [count + 1] */
    Vec2 *points; /* [start[count]] */
} PlotLayer;

typedef struct Plot {
    double paper[2]; /* width and height, mm         */
    Color color;     /* of the paper; a = 0: not said */
    int layer_count;
    PlotLayer *layers;
} Plot;

/* Writes an SVG in millimetres: width and height in mm, one user unit a millimetre, cubic curves rounded to
 * micrometres, a layer "1-black" of Inkscape's kind at the top level for each pen (AxiDraw and vpype read the
 * number) whose ink lets those below shine through unless it is opaque, no transforms, no frame. The colour
 * of a paper that is not white is a style of the whole: no shape that a plotter would draw. Layers without curves are left out, but
 * count. */
bool plot_write_svg(const char *path, const Plot *plot, Error *err);

enum { PLOTTER_COMMAND_MAX = 60 }; /* characters */

/* How fast a plotter is, and how its pen is lifted. */
typedef struct Plotter {
    double down, up;     /* mm/s, pen down and pen up                 */
    double lift;         /* s, to lift and to lower the pen, together */
    double z_up, z_down; /* mm, of a pen on a z axis                  */
    double z_speed;      /* mm/s, at most                             */
    double pause;        /* s, what G4 P1 waits: 1, or 0.001 (Marlin) */
    char servo_up[PLOTTER_COMMAND_MAX + 1], servo_down[PLOTTER_COMMAND_MAX + 1]; /* commands */
} Plotter;

/* A common pen plotter: 40 and 100 mm/s, 0.3 s; z = 5 and 0 at 10 mm/s; M5 and M3 S30, pauses in seconds. */
Plotter plotter_default(void);

/* May it be a command in a file? Up to 60 letters, digits, spaces and . - + _ =, a letter first. */
bool plotter_is_command(const char *command);

/* False and a sentence where numbers of it are no numbers that a file could have (results of others). */
bool plotter_check(const Plotter *plotter, Error *err);

/* s, to lift and to lower a pen on a z axis: `lift`, or longer where z_speed asks for that. */
double plotter_z_lift(const Plotter *plotter);

/* Of one layer. Its pen comes from the paper's top left corner and returns there. */
typedef struct PlotEstimate {
    double ink, travel; /* mm drawn, mm moved with the pen up */
    double seconds;
} PlotEstimate;

/* Constant speeds, no acceleration: short curves take longer than this on a heavy machine. */
PlotEstimate plot_estimate(const PlotLayer *layer, const Plotter *plotter);

/* The words of a machine's language. Templates may hold {x} and {y} (where to go), {feed} and {travel_feed}
 * (speeds, mm/min), {velocity} (pen down, whole cm/s, 1 at least), {z_up}, {z_down} (mm) and {z_feed}
 * (mm/min, with which lifting and lowering take their time), {servo_up} and {servo_down} (commands), {pause}
 * (for G4 P: the time to lift and to lower) and {half_pause}, {pen} (from 1) and {name} (of the layer); any
 * template may be "". */
typedef struct PlotProfile {
    const char *header, *footer;
    const char *change; /* before every layer but the first */
    const char *layer;  /* at the start of every layer */
    const char *travel; /* to the start of a curve, the pen is up */
    const char *down;
    const char *line; /* straight on to the next point, the pen is down */
    const char *up;
    double units;     /* of {x} and {y} per mm */
    int decimals;     /* of {x} and {y} */
    double tolerance; /* mm, of the chords that replace a curve */
    bool y_up;        /* y counts from the lower edge of the paper */
    bool turn;        /* a paper that is higher than wide lies turned by a quarter, clockwise */
    double origin[2]; /* mm, the machine's (0, 0) from the corner that x and y count from */
    double limits[2]; /* mm, how far it reaches from there; 0: no matter */
    const char
        *refill; /* before a curve with which more than so much were drawn since the last one; NULL: none */
    double refill_after; /* mm of ink, by one pen; a curve is never broken */
} PlotProfile;

/* By name; a sentence for an unknown one.
 *   gcode        mm, pen on a z axis, whose speed makes the time of lifts (Marlin, GRBL, LinuxCNC)
 *   gcode_servo  mm, pen on a servo, with pauses of half the time of a lift (GRBL, Marlin)
 *   hpgl         40 units per mm, SP per pen, VS: its speed; x to the right and y up from the lower left
 *                corner. The plotter lifts the pen as it can: no word of HPGL waits */
bool plot_profile(const char *name, PlotProfile *profile, Error *err);

/* From a YAML file of one's own (scenes/plotters/, docs/line_art.md): the table of io/plot_profile.c. A sentence with the
 * line where it is refused. The profile owns its words then: clear it. */
bool plot_profile_read(const char *path, PlotProfile *profile, Error *err);
/* The same of such a file's text; `path` is for the sentence. */
bool plot_profile_parse(const char *path, const char *text, size_t length, PlotProfile *profile, Error *err);
void plot_profile_clear(PlotProfile *profile);

/* Is a place of the paper (mm, as in PlotLayer) within the limits? */
bool plot_profile_reaches(const PlotProfile *profile, const double paper[2], Vec2 place, Error *err);

/* Do its pens go up and down with {z_feed}, so that lifts take as long as a z axis does? */
bool plot_profile_lifts_by_z(const PlotProfile *profile);

/* Is every word in braces one that stands for something? */
bool plot_words_check(const char *words, Error *err);

/* Writes the plot in the words of a profile, curves as chords. */
bool plot_write_machine(const char *path, const Plot *plot, const PlotProfile *profile,
                        const Plotter *plotter, Error *err);
