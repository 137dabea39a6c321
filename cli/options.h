/* options.h - what is given to a verb: rows of options, and one argument.
 *
 * A row says where its value goes and what is allowed; whatever else is given, or a value twice, is refused with one
 * sentence that names it. --help prints how the verb is used, and --options, for shells that complete what is typed, its rows. */
#pragma once
#include <stdbool.h>

typedef enum OptionKind {
    OPTION_FLAG,   /* bool: true when it is given                       */
    OPTION_TEXT,   /* const char *, as it is given                      */
    OPTION_INT,    /* int from `least` to `most`                        */
    OPTION_DOUBLE, /* double from `least` to `most`                     */
    OPTION_CHOICE, /* int or enum: which of `words` it is, from 1       */
    OPTION_OTHER,  /* whatever `take` makes of the text                 */
} OptionKind;

typedef struct Option {
    const char *name; /* "output" for --output */
    char letter;      /* 'o' for -o; 0: none */
    OptionKind kind;
    void *value;
    double least, most;
    bool (*take)(void *value, const char *text); /* false: it is not allowed */
    const char *allowed; /* where `take` is: "must be .."; of the others it is known */
    const char *const
        *words; /* NULL-terminated; what shells complete: words, the endings of files (".png"), or what
                               * can be had elsewhere, in capitals (--set: "KEY"). NULL: nothing is known */
} Option;

#define OPTION_WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* Fills in what is given. `usage` begins with the verb's name and, where there is one, that of its argument, which
 * *argument gets ("run SCENE [-o NAME] .."); a verb without one passes NULL. False where nothing is left to do:
 * *code is what the verb returns then. */
bool options_parse(int argc, char **argv, const char *usage, const Option *options, int count,
                   const char **argument, int *code);

/* The same of a verb that takes one argument or more: *arguments, in argv. */
bool options_parse_all(int argc, char **argv, const char *usage, const Option *options, int count,
                       char ***arguments, int *argument_count, int *code);

/* Assignments "key=value" to a scene. */
enum { SETTINGS_MAX = 64 };

typedef struct Settings {
    char *text[SETTINGS_MAX]; /* owned */
    int count;
} Settings;

/* `take` of a row whose value is Settings, and what it allows. */
bool settings_take(void *settings, const char *text);
#define SETTINGS_ALLOWED "key=value, and given 64 times at most"
#define SETTINGS_WORDS   OPTION_WORDS("KEY")

/* The same of a key of its own. */
bool settings_put(Settings *settings, const char *key, const char *value);
void settings_clear(Settings *settings);
