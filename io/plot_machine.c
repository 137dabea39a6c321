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
    {"gcode", GCODE_PROFILE("G0 Z5 F600\n", "G1 Z0 F600\n", "G0 Z5 F600\n")},
    {"gcode_servo", GCODE_PROFILE("M5\nG4 P0.3\n", "M3 S30\nG4 P0.15\n", "M5\nG4 P0.15\n")},
    {"hpgl",
     {.header = "IN;\n",
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
    return error_set(err, "\"%s\" is no plotter's language; say gcode, gcode_servo or hpgl", name);
}

/* What is being written, and what the words in braces stand for. */
typedef struct Writer {
    Text text;
    const PlotProfile *profile;
    PlotSpeed speed;
    double height; /* of the paper, mm */
    Vec2 at;       /* {x} and {y} */
    int pen;
    const char *name;
} Writer;

/* For a comment. Machines obey bytes there, too: grbl takes ! ? ~ and all from 0x80 on out of the stream as
 * they come, ( ) ; end comments or begin them, * is Marlin's checksum. Letters, digits and a few signs stay;
 * each other character becomes _, and what would make the line longer than others is cut. */
static void add_name(Text *text, const char *name)
{
    int room = 60;
    for (const char *c = name; *c && room > 0; c++) {
        if (((unsigned char)*c & 0xc0) == 0x80) continue; /* a further byte of a character in UTF-8 */
        bool plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9');
        text_add(text, "%c", plain || strchr(" .,-+_", *c) ? *c : '_');
        room--;
    }
}

/* Writes what a word in braces stands for, if it is one. */
static bool add_word(Writer *writer, const char *word, size_t length)
{
    static const char *const words[] = {"{x}", "{y}", "{feed}", "{travel_feed}"};
    double numbers[] = {writer->at.x, writer->at.y, 60 * writer->speed.down, 60 * writer->speed.up};
    for (int k = 0; k < 4; k++) {
        if (strlen(words[k]) != length || memcmp(word, words[k], length) != 0) continue;
        plot_add_number(&writer->text, numbers[k], k < 2 ? writer->profile->decimals : 1);
        return true;
    }
    if (length == 5 && !memcmp(word, "{pen}", 5)) {
        text_add(&writer->text, "%d", writer->pen);
        return true;
    }
    if (length == 6 && !memcmp(word, "{name}", 6)) {
        add_name(&writer->text, writer->name);
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

/* In the machine's units, as they will be written. */
static Vec2 machine_point(const Writer *writer, Vec2 p)
{
    const PlotProfile *profile = writer->profile;
    double scale = profile->units, tick = pow(10, -profile->decimals);
    return (Vec2){tick * round(scale * p.x / tick),
                  tick * round(scale * (profile->y_up ? writer->height - p.y : p.y) / tick)};
}

/* Points that round to where the pen is are no moves. */
static void add_curve(Writer *writer, const Vec2 *c, const Vec2 *end)
{
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

bool plot_write_machine(const char *path, const Plot *plot, const PlotProfile *profile, PlotSpeed speed,
                        Error *err)
{
    Writer writer = {.profile = profile, .speed = speed, .height = plot->paper[1], .name = ""};
    bool first = true;
    if (!plot_check(path, plot, err)) return false;
    add_template(&writer, profile->header);
    for (int k = 0; k < plot->layer_count; k++) {
        const PlotLayer *layer = &plot->layers[k];
        if (!layer->count) continue;
        writer.pen = k + 1;
        writer.name = layer->name;
        if (!first) add_template(&writer, profile->change);
        add_template(&writer, profile->layer);
        first = false;
        for (int i = 0; i < layer->count; i++)
            add_curve(&writer, layer->points + layer->start[i], layer->points + layer->start[i + 1] - 1);
    }
    add_template(&writer, profile->footer);
    bool ok = safe_file_write(path, writer.text.text, writer.text.length, false, err);
    mem_free(writer.text.text);
    return ok;
}
