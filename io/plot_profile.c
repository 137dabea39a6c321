/* Profiles of machines from files of their own, of the table below. */
#include "io/plot_file.h"
#include "io/plot_text.h"
#include "io/text.h"
#include "base/memory.h"
#include "base/plain.h"
#include "io/yaml.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

typedef enum PaperTurn { TURN_NEVER, TURN_PORTRAIT } PaperTurn;

typedef enum PaperCorner { CORNER_LOWER_LEFT, CORNER_UPPER_LEFT } PaperCorner;

typedef struct ProfileFile {
    char *header, *footer, *change, *layer, *travel, *down, *line, *up, *refill;
    double units, tolerance, origin[2], limits[2], refill_after;
    int decimals, corner, turn; /* PaperCorner, PaperTurn */
} ProfileFile;

#define WORDS(m, must, what)                                                                                 \
    {                                                                                                        \
        YAML_TEXT(ProfileFile, m), .required = must, .doc = what                                             \
    }
static const YamlTable table = {
    .name = "profile",
    .size = sizeof(ProfileFile),
    .doc = "The words of a plotter's language, with what stands for numbers in braces (docs/line_art.md).",
    .fields = (const YamlField[]){
        WORDS(header, false, "first of all"),
        WORDS(footer, false, "last of all"),
        WORDS(change, false, "before every pen but the first"),
        WORDS(layer, false, "at the start of every pen"),
        WORDS(travel, true, "to the start of a stroke, the pen is up"),
        WORDS(down, true, "lowers the pen"),
        WORDS(line, true, "straight on to the next point, the pen is down"),
        WORDS(up, true, "lifts the pen"),
        WORDS(refill, false, "before a stroke that would make more than `refill_after` of ink"),
        {YAML_NUMBER(ProfileFile, refill_after), .unit = "m", .range = "(0, inf)",
         .doc = "ink between two refills; a longer stroke is not broken"},
        {YAML_NUMBER(ProfileFile, units), .range = "(0, 1.0e+6]", .fallback = "1",
         .doc = "of {x} and {y} in a millimetre"},
        {YAML_INTEGER(ProfileFile, decimals), .range = "[0, 9]", .fallback = "3", .doc = "of {x} and {y}"},
        {YAML_NUMBER(ProfileFile, tolerance), .unit = "m", .range = "[1.0e-6, 0.01]", .fallback = "0.05 mm",
         .doc = "of the chords that replace a curve"},
        {YAML_CHOICE(ProfileFile, corner), .choices = YAML_NAMES("lower_left", "upper_left"),
         .fallback = "lower_left", .doc = "of the paper from which x goes right and y up, or down"},
        {YAML_CHOICE(ProfileFile, turn), .choices = YAML_NAMES("never", "portrait"), .fallback = "never",
         .doc = "a page that is higher than wide lies turned by a quarter, clockwise"},
        {YAML_VECTOR(ProfileFile, origin), .unit = "m", .range = "[-10, 10]", .fallback = "[0, 0]",
         .doc = "where the machine's (0, 0) is, from that corner"},
        {YAML_VECTOR(ProfileFile, limits), .unit = "m", .range = "(0, 100]",
         .doc = "how far it reaches from its (0, 0); a plot beyond it is refused"},
        {0}}};

/* Words that go nowhere would draw nothing. */
static bool check_place(const char *at, const char *words, YamlFile *file)
{
    return (strstr(words, "{x}") && strstr(words, "{y}")) ||
           yaml_refuse(file, at, "these words do not say where to: {x} and {y} are needed");
}

static bool check_words(const ProfileFile *from, YamlFile *file)
{
    const struct {
        const char *key, *words;
    } all[] = {{"header", from->header}, {"footer", from->footer}, {"change", from->change},
               {"layer", from->layer},   {"travel", from->travel}, {"down", from->down},
               {"line", from->line},     {"up", from->up},         {"refill", from->refill}};
    bool ok = true;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        Error err;
        if (all[k].words && !plot_words_check(all[k].words, &err))
            ok = yaml_refuse(file, all[k].key, "%s", err.text);
    }
    if (from->refill && isnan(from->refill_after))
        ok = yaml_refuse(file, "refill", "after how much ink? Say `refill_after`");
    if (!from->refill && !isnan(from->refill_after))
        ok = yaml_refuse(file, "refill_after", "this needs the words of `refill`");
    return ok;
}

static char *words_of(const char *words)
{
    return mem_text(words ? words : "");
}

static PlotProfile profile_of(const ProfileFile *from)
{
    PlotProfile to = {.header = words_of(from->header),
                      .footer = words_of(from->footer),
                      .change = words_of(from->change),
                      .layer = words_of(from->layer),
                      .travel = words_of(from->travel),
                      .down = words_of(from->down),
                      .line = words_of(from->line),
                      .up = words_of(from->up),
                      .refill = words_of(from->refill),
                      .units = from->units,
                      .decimals = from->decimals,
                      .tolerance = 1e3 * from->tolerance,
                      .y_up = from->corner == CORNER_LOWER_LEFT,
                      .turn = from->turn == TURN_PORTRAIT,
                      .refill_after = from->refill ? 1e3 * from->refill_after : 0};
    for (int k = 0; k < 2; k++) {
        to.origin[k] = 1e3 * from->origin[k];
        to.limits[k] = isnan(from->limits[0]) ? 0 : 1e3 * from->limits[k];
    }
    return to;
}

/* The first thing that is wrong with the file, in one line. */
static bool refuse(const YamlFile *file, const char *path, Error *err)
{
    int count;
    const YamlError *first = yaml_errors(file, &count);
    char *sentence = plain_text(first->sentence, "");
    if (first->line)
        error_set(err, "%s:%d:%d: %s", path, first->line, first->column, sentence);
    else
        error_set(err, "%s: %s", path, sentence);
    mem_free(sentence);
    return false;
}

static bool take(YamlFile *file, const char *path, PlotProfile *profile, Error *err)
{
    ProfileFile from;
    bool ok = (yaml_load(file, &table, &from) && check_place("travel", from.travel, file) &&
               check_place("line", from.line, file) && check_words(&from, file)) ||
              refuse(file, path, err);
    *profile = ok ? profile_of(&from) : (PlotProfile){0};
    yaml_clear(&table, &from);
    yaml_destroy(file);
    return ok;
}

bool plot_profile_read(const char *path, PlotProfile *profile, Error *err)
{
    return take(yaml_read(path), path, profile, err);
}

bool plot_profile_parse(const char *path, const char *text, size_t length, PlotProfile *profile, Error *err)
{
    return take(yaml_parse(path, text, length), path, profile, err);
}

bool plot_profile_lifts_by_z(const PlotProfile *profile)
{
    return strstr(profile->down, "{z_feed}") || strstr(profile->up, "{z_feed}");
}

void plot_profile_clear(PlotProfile *p)
{
    const char *words[] = {p->header, p->footer, p->change, p->layer, p->travel,
                           p->down,   p->line,   p->up,     p->refill};
    for (size_t k = 0; k < sizeof words / sizeof *words; k++) mem_free((char *)words[k]);
    *p = (PlotProfile){0};
}
