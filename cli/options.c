#include "cli/options.h"
#include "base/memory.h"
#include "cli/say.h"
#include "cli/verb.h"
#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 256, FIRST }; /* what getopt calls --options and the first row: letters are below */

/* ---- One value ---- */

static bool take_int(const Option *option, const char *text)
{
    char *end;
    errno = 0;
    long number = strtol(text, &end, 10);
    if (end == text || *end || errno || number < option->least || number > option->most) return false;
    *(int *)option->value = (int)number;
    return true;
}

static bool take_double(const Option *option, const char *text)
{
    char *end;
    double number = strtod(text, &end);
    if (end == text || *end || !(number >= option->least && number <= option->most)) return false;
    *(double *)option->value = number;
    return true;
}

static bool take_choice(const Option *option, const char *text)
{
    for (int k = 0; option->words[k]; k++)
        if (!strcmp(option->words[k], text)) return *(int *)option->value = k + 1, true;
    return false;
}

static bool take(const Option *option, const char *text)
{
    switch (option->kind) {
    case OPTION_FLAG:
        return *(bool *)option->value = true;
    case OPTION_TEXT:
        *(const char **)option->value = text;
        return true;
    case OPTION_INT:
        return take_int(option, text);
    case OPTION_DOUBLE:
        return take_double(option, text);
    case OPTION_CHOICE:
        return take_choice(option, text);
    case OPTION_OTHER:
        break;
    }
    return option->take(option->value, text);
}

/* "beside, over or both"; the caller frees. */
static char *choices_text(const char *const *words)
{
    char *text = mem_text(words[0]);
    for (int k = 1; words[k]; k++) text = mem_join(text, words[k + 1] ? ", " : " or ", words[k]);
    return text;
}

/* "a whole number from 1 to 64"; the caller frees. */
static char *allowed_of(const Option *option)
{
    if (option->kind == OPTION_TEXT) return mem_text("a text");
    if (option->kind == OPTION_OTHER) return mem_text(option->allowed);
    if (option->kind == OPTION_CHOICE) return choices_text(option->words);
    const char *number = option->kind == OPTION_INT ? "a whole number" : "a number";
    return option->most == INT_MAX ? mem_format("%s from %g", number, option->least)
                                   : mem_format("%s from %g to %g", number, option->least, option->most);
}

/* ---- What is refused ---- */

/* The caller's sentence, which is freed, and where to read on; returns false, as parsing then does. */
static bool refuse(const char *usage, char *sentence, int *code)
{
    char *whole =
        mem_format("%s; slender %.*s --help says more", sentence, (int)strcspn(usage, " \n"), usage);
    *code = verb_fail(RUN_USAGE, whole);
    mem_free(whole);
    mem_free(sentence);
    return false;
}

static char *value_sentence(const Option *option, const char *text)
{
    char *allowed = allowed_of(option);
    char *sentence = text ? mem_format("--%s must be %s, and is '%s'", option->name, allowed, text)
                          : mem_format("--%s needs a value: %s", option->name, allowed);
    mem_free(allowed);
    return sentence;
}

/* What getopt has stopped at: a letter, or the word before the next one. */
static char *unknown_sentence(char **argv)
{
    if (optopt >= ROWS) return mem_format("'%s': this option takes no value", argv[optind - 1]);
    return optopt ? mem_format("there is no option -%c", optopt)
                  : mem_format("there is no option %s", argv[optind - 1]);
}

static char *argument_sentence(const char *usage, int given, const char *first)
{
    const char *name = usage + strcspn(usage, " \n");
    name += *name == ' ';
    int length = (int)strcspn(name, " \n");
    if (given == 0) return mem_format("a %.*s must be given", length, name);
    return mem_format("one %.*s can be given, and %d are, from '%s'", length, name, given, first);
}

/* ---- All of them ---- */

/* "argument - value SCENE", then "--output -o value .png .svg", "--force - flag", .. */
static void print_rows(const char *usage, const Option *options, int count)
{
    const char *argument = usage + strcspn(usage, " \n");
    int length = (int)strcspn(argument, "[-\n");
    if (length > 1) printf("argument - value%.*s\n", length, argument);
    for (int k = 0; k < count; k++) {
        const Option *option = &options[k];
        char letter[] = {'-', option->letter, 0};
        printf("--%s %s %s", option->name, letter, option->kind == OPTION_FLAG ? "flag" : "value");
        for (int w = 0; option->words && option->words[w]; w++) printf(" %s", option->words[w]);
        printf("\n");
    }
}

/* Rows as getopt has them; the caller frees. */
static struct option *long_options(const Option *options, int count)
{
    struct option *table = mem_alloc((size_t)count + 3, sizeof *table);
    for (int k = 0; k < count; k++)
        table[k] =
            (struct option){options[k].name, options[k].kind == OPTION_FLAG ? no_argument : required_argument,
                            NULL, FIRST + k};
    table[count] = (struct option){"help", no_argument, NULL, 'h'};
    table[count + 1] = (struct option){"options", no_argument, NULL, ROWS};
    return table;
}

/* ":ho:": missing values are told apart from what is unknown; the caller frees. */
static char *short_options(const Option *options, int count)
{
    char *letters = mem_text(":h");
    for (int k = 0; k < count; k++) {
        char letter[] = {options[k].letter, options[k].kind == OPTION_FLAG ? 0 : ':', 0};
        if (letter[0]) letters = mem_join(letters, "", letter);
    }
    return letters;
}

static const Option *row_of(const Option *options, int count, int name)
{
    for (int k = 0; k < count; k++)
        if (name == FIRST + k || (name == options[k].letter && name)) return &options[k];
    return NULL;
}

/* Else the last of two would win in silence. What others make of several is their own: --set. */
static bool has_one_value(const Option *option)
{
    return option->kind != OPTION_FLAG && option->kind != OPTION_OTHER;
}

/* Leaves optind at the arguments. */
static bool take_all(int argc, char **argv, const char *usage, const Option *options, int count, int *code)
{
    struct option *table = long_options(options, count);
    char *letters = short_options(options, count);
    bool ok = true;
    bool *given = mem_alloc((size_t)count, sizeof *given);
    opterr = 0;
    for (int c; ok && (c = getopt_long(argc, argv, letters, table, NULL)) >= 0;) {
        const Option *option = row_of(options, count, c == ':' ? optopt : c);
        if (c == 'h' || c == ROWS) {
            if (c == 'h')
                printf("usage: slender %s\n", usage);
            else
                print_rows(usage, options, count);
            *code = RUN_DONE;
            ok = false;
        } else if (!option)
            ok = refuse(usage, unknown_sentence(argv), code);
        else if (c == ':' || !take(option, optarg))
            ok = refuse(usage, value_sentence(option, c == ':' ? NULL : optarg), code);
        else if (has_one_value(option) && given[option - options])
            ok = refuse(usage,
                        mem_format("--%s is given twice, the second time as '%s'", option->name, optarg),
                        code);
        else
            given[option - options] = true;
    }
    mem_free(table);
    mem_free(letters);
    mem_free(given);
    return ok;
}

bool options_parse(int argc, char **argv, const char *usage, const Option *options, int count,
                   const char **argument, int *code)
{
    if (!take_all(argc, argv, usage, options, count, code)) return false;
    int given = argc - optind;
    if (!argument && given > 0)
        return refuse(usage, mem_format("'%s': no argument can be given here", argv[optind]), code);
    if (argument && given != 1) return refuse(usage, argument_sentence(usage, given, argv[optind]), code);
    if (argument) *argument = argv[optind];
    return true;
}

bool options_parse_all(int argc, char **argv, const char *usage, const Option *options, int count,
                       char ***arguments, int *argument_count, int *code)
{
    if (!take_all(argc, argv, usage, options, count, code)) return false;
    *arguments = argv + optind, *argument_count = argc - optind;
    return *argument_count > 0 || refuse(usage, argument_sentence(usage, 0, NULL), code);
}

/* ---- Settings ---- */

bool settings_put(Settings *settings, const char *key, const char *value)
{
    if (settings->count == SETTINGS_MAX) return false;
    settings->text[settings->count++] = mem_format("%s%s", key, value);
    return true;
}

bool settings_take(void *settings, const char *text)
{
    return settings_put(settings, "", text);
}

void settings_clear(Settings *settings)
{
    for (int k = 0; k < settings->count; k++) mem_free(settings->text[k]);
    settings->count = 0;
}
