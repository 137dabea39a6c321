#include "base/cubic.h"
#include "base/memory.h"
#include "io/plot_text.h"
#include "io/safe_file.h"
#include <string.h>

typedef struct Named {
    const char *name;
    PlotProfile profile;
} Named;

/* Every G0 and G1 says its speed: some controllers know only one for both. */
#define GCODE_PROFILE(begin, lower, raise)                                                                   \
    {                                                                                                        \
        .header = "G21 ; mm\nG90 ; absolute\n" begin, .footer = "G0 X0 Y0 F{travel_feed}\nM2\n",             \
        .change = "G0 X0 Y0 F{travel_feed}\nM0 ; pen {pen}, then go on\n",                                   \
        .layer = "; layer {pen}-{name}\n", .travel = "G0 X{x} Y{y} F{travel_feed}\n", .down = lower,         \
        .line = "G1 X{x} Y{y} F{feed}\n", .up = raise, .units = 1, .decimals = 3, .tolerance = 0.05,         \
        .y_up = true                                                                                         \
    }

static const Named profiles[] = {
    {"gcode", GCODE_PROFILE("G0 Z{z_up} F{z_feed}\n", "G1 Z{z_down} F{z_feed}\n", "G0 Z{z_up} F{z_feed}\n")},
    {"gcode_servo", GCODE_PROFILE("{servo_up}\nG4 P{pause}\n", "{servo_down}\nG4 P{half_pause}\n",
                                  "{servo_up}\nG4 P{half_pause}\n")},
    {"hpgl",
     {.header = "IN;VS{velocity};\n",
      .footer = "PU;SP0;\n",
      .change = "",
      .layer = "SP{pen};\n",
      .travel = "PU{x},{y};\n",
      .down = "PD;\n",
      .line = "PD{x},{y};\n",
      .up = "PU;\n",
      .units = 40,
      .decimals = 0,
      .tolerance = 0.05,
      .y_up = true}},
};

bool plot_profile(const char *name, PlotProfile *profile, Error *err)
{
    for (size_t k = 0; k < sizeof profiles / sizeof *profiles; k++) {
        if (strcmp(name, profiles[k].name) != 0) continue;
        *profile = profiles[k].profile;
        return true;
    }
    return error_set(err,
                     "\"%s\" is no plotter's language; say gcode, gcode_servo or hpgl, or the path of a "
                     "profile, a .yaml file",
                     name);
}

/* What is being written, and what the words in braces stand for. */
typedef struct Writer {
    Text text;
    const PlotProfile *profile;
    const Plotter *plotter;
    const double *paper; /* mm */
    Vec2 at;             /* {x} and {y} */
    double ink;          /* mm, since the last refill */
    int pen;
    char *name;
} Writer;

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/* Of a layer, for a comment; owned. Machines obey bytes there, too: grbl takes ! ? ~ and all from 0x80 on out
 * of the stream as they come, ( ) ; end comments or begin them, * is Marlin's checksum. Letters, digits and a
 * few signs stay; each other character becomes _, and what would make the line longer than others is cut. */
static char *plain_name(const char *name)
{
    Text text = {0};
    text_add(&text, "%s", "");
    for (const char *c = name; *c && text.length < PLOTTER_COMMAND_MAX; c++) {
        if (((unsigned char)*c & 0xc0) == 0x80) continue; /* a further byte of a character in UTF-8 */
        bool plain = is_letter(*c) || strchr("0123456789 .,-+_", *c);
        text_add(&text, "%c", plain ? *c : '_');
    }
    return text.text;
}

bool plotter_is_command(const char *command)
{
    size_t length = strlen(command);
    for (const char *c = command; *c; c++)
        if (!is_letter(*c) && !strchr("0123456789 .-+_=", *c)) return false;
    return is_letter(command[0]) && length <= PLOTTER_COMMAND_MAX;
}

/* A word in braces, and what it stands for: a number, or a text. */
typedef struct Word {
    const char *word;
    double number;
    int decimals;
    const char *text;
} Word;

/* Writes what a word stands for, if it is one. */
static bool add_word(Writer *writer, const char *word, size_t length)
{
    const Plotter *p = writer->plotter;
    double z_feed = 120 * fabs(p->z_up - p->z_down) / plotter_z_lift(p);
    const Word words[] = {{"{x}", writer->at.x, writer->profile->decimals, NULL},
                          {"{y}", writer->at.y, writer->profile->decimals, NULL},
                          {"{feed}", 60 * p->down, 1, NULL},
                          {"{travel_feed}", 60 * p->up, 1, NULL},
                          {"{velocity}", fmin(fmax(p->down / 10, 1), 127), 0, NULL},
                          {"{z_up}", p->z_up, 3, NULL},
                          {"{z_down}", p->z_down, 3, NULL},
                          {"{z_feed}", z_feed, 1, NULL},
                          {"{pause}", p->lift / p->pause, 4, NULL},
                          {"{half_pause}", p->lift / (2 * p->pause), 4, NULL},
                          {"{pen}", writer->pen, 0, NULL},
                          {"{servo_up}", 0, 0, p->servo_up},
                          {"{servo_down}", 0, 0, p->servo_down},
                          {"{name}", 0, 0, writer->name}};
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
        if (strlen(words[k].word) != length || memcmp(word, words[k].word, length) != 0) continue;
        if (words[k].text)
            text_add(&writer->text, "%s", words[k].text);
        else
            plot_add_number(&writer->text, words[k].number, words[k].decimals);
        return true;
    }
    return false;
}

/* Braces around any other word stay as they are. */
static void add_template(Writer *writer, const char *words)
{
    while (*words) {
        const char *end = *words == '{' ? strchr(words, '}') : NULL;
        size_t length = end ? (size_t)(end + 1 - words) : 0;
        if (!length || !add_word(writer, words, length)) {
            length = 1 + strcspn(words + 1, "{");
            text_add(&writer->text, "%.*s", (int)length, words);
        }
        words += length;
    }
}

bool plot_words_check(const char *words, Error *err)
{
    const Plotter plotter = plotter_default();
    const PlotProfile profile = {0};
    Writer writer = {.profile = &profile, .plotter = &plotter, .name = ""};
    bool ok = true;
    for (const char *c = strchr(words, '{'); ok && c; c = strchr(c + 1, '{')) {
        const char *end = strchr(c, '}');
        size_t length = strcspn(c, "} \n");
        ok =
            (end && add_word(&writer, c, (size_t)(end + 1 - c))) ||
            error_set(
                err,
                "\"%.*s\" stands for nothing; there are {x}, {y}, {feed}, {travel_feed}, {velocity}, {z_up}, "
                "{z_down}, {z_feed}, {servo_up}, {servo_down}, {pause}, {half_pause}, {pen} and {name}",
                (int)length + (c[length] == '}'), c);
    }
    mem_free(writer.text.text);
    return ok;
}

/* Where the machine has a place of the paper, mm. */
static Vec2 machine_place(const PlotProfile *profile, const double paper[2], Vec2 p)
{
    double width = paper[0], height = paper[1];
    if (profile->turn && height > width) {
        p = (Vec2){height - p.y, p.x};
        height = width;
    }
    return (Vec2){p.x - profile->origin[0], (profile->y_up ? height - p.y : p.y) - profile->origin[1]};
}

/* In the machine's units, as they will be written. */
static Vec2 machine_point(const Writer *writer, Vec2 p)
{
    const PlotProfile *profile = writer->profile;
    double scale = profile->units, tick = pow(10, -profile->decimals);
    Vec2 at = machine_place(profile, writer->paper, p);
    return (Vec2){tick * round(scale * at.x / tick), tick * round(scale * at.y / tick)};
}

bool plot_profile_reaches(const PlotProfile *profile, const double paper[2], Vec2 place, Error *err)
{
    const double *limits = profile->limits, slack = 0.01; /* a hundredth of a millimetre is nothing */
    Vec2 at = machine_place(profile, paper, place);
    return limits[0] == 0 ||
           (fmin(at.x, at.y) >= -slack && at.x <= limits[0] + slack && at.y <= limits[1] + slack) ||
           error_set(err,
                     "the plot has a point where the machine has (%.4g, %.4g) mm, and it reaches from "
                     "(0, 0) to (%g, %g) mm; a wider margin or a smaller page helps",
                     at.x, at.y, limits[0], limits[1]);
}

/* All control points, in whose hull the curves lie. */
static bool check_limits(const PlotProfile *profile, const char *path, const Plot *plot, Error *err)
{
    for (int k = 0; k < plot->layer_count; k++) {
        const PlotLayer *layer = &plot->layers[k];
        for (int i = 0; i < (layer->count ? layer->start[layer->count] : 0); i++)
            if (!plot_profile_reaches(profile, plot->paper, layer->points[i], err))
                return error_prefix(err, "%s", path);
    }
    return true;
}

static void refill(Writer *writer, const Vec2 *c, const Vec2 *end)
{
    if (!writer->profile->refill_after) return;
    double length = 0;
    plot_add_length(c, end, &length);
    if (writer->ink > 0 && writer->ink + length > writer->profile->refill_after) {
        add_template(writer, writer->profile->refill);
        writer->ink = 0;
    }
    writer->ink += length;
}

/* Points that round to where the pen is are no moves. */
static void add_curve(Writer *writer, const Vec2 *c, const Vec2 *end)
{
    refill(writer, c, end);
    writer->at = machine_point(writer, *c);
    add_template(writer, writer->profile->travel);
    add_template(writer, writer->profile->down);
    for (; c < end; c += 3) {
        int steps = cubic_steps(c, writer->profile->tolerance);
        for (int i = 1; i <= steps; i++) {
            Vec2 next = machine_point(writer, i < steps ? cubic_at(c, (double)i / steps) : c[3]);
            if (next.x == writer->at.x && next.y == writer->at.y) continue;
            writer->at = next;
            add_template(writer, writer->profile->line);
        }
    }
    add_template(writer, writer->profile->up);
}

bool plot_write_machine(const char *path, const Plot *plot, const PlotProfile *profile,
                        const Plotter *plotter, Error *err)
{
    Writer writer = {.profile = profile, .plotter = plotter, .paper = plot->paper};
    bool first = true;
    if (!plot_check(path, plot, err) || !check_limits(profile, path, plot, err)) return false;
    add_template(&writer, profile->header);
    for (int k = 0; k < plot->layer_count; k++) {
        const PlotLayer *layer = &plot->layers[k];
        if (!layer->count) continue;
        writer.pen = k + 1;
        writer.ink = 0;
        writer.name = plain_name(layer->name);
        if (!first) add_template(&writer, profile->change);
        add_template(&writer, profile->layer);
        first = false;
        for (int i = 0; i < layer->count; i++)
            add_curve(&writer, layer->points + layer->start[i], layer->points + layer->start[i + 1] - 1);
        mem_free(writer.name);
    }
    add_template(&writer, profile->footer);
    bool ok = safe_file_write(path, writer.text.text, writer.text.length, false, err);
    mem_free(writer.text.text);
    return ok;
}
