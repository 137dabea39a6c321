/* slender - simulates and designs slender things: the verbs, and what they return. */
#include "base/memory.h"
#include "cli/kernels_start.h"
#include "cli/say.h"
#include "cli/verb.h"
#include "solve/ranks.h"
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static int verb_help(int argc, char **argv);
static int verb_version(int argc, char **argv);

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *doc;
} verbs[] = {
    {"run", verb_run, "run a scene file and write its result"},
    {"check", verb_check, "check a scene file: what it says, and how long it may take"},
    {"info", verb_info, "say what is in a result or a running job"},
    {"export", verb_export,
     "CSV of a dataset, OBJ of a frame, SVG or G-code of a drawing, the result of a running job"},
    {"picture", verb_picture, "draw a result: PNG, SVG or PDF"},
    {"schema", verb_schema, "JSON Schema, or the manual, of scene files"},
    {"mesh", verb_mesh, "write a scene's mesh as OBJ"},
    {"help", verb_help, "say this"},
    {"version", verb_version, "name the program and the libraries that it found"},
};

enum { VERB_COUNT = sizeof verbs / sizeof *verbs };

static int verb_help(int argc, char **argv)
{
    static const char usage[] = "help\n  Lists the verbs.";
    int code;
    if (!options_parse(argc, argv, usage, NULL, 0, NULL, &code)) return code;
    printf(
        "slender simulates and designs magnetised thin shells and elastic rods, and draws with splines.\n\n");
    for (int k = 0; k < VERB_COUNT; k++) printf("  slender %-8s  %s\n", verbs[k].name, verbs[k].doc);
    printf("\nEach verb explains its options: slender run --help\n"
           "Exit codes: 0 done; 1 computed but did not converge; 2 usage; 3 scene or mesh refused; 4 cannot "
           "write;\n"
           "5 out of memory; 75 interrupted, state saved: run again with --resume\n");
    return RUN_DONE;
}

static int verb_version(int argc, char **argv)
{
    static const char usage[] = "version\n  Names the program and the libraries that it found.";
    int code;
    if (!options_parse(argc, argv, usage, NULL, 0, NULL, &code)) return code;
    char *text = run_versions();
    fputs(text, stdout);
    mem_free(text);
    return RUN_DONE;
}

/* A file that is opened never gets the number of a stream that was closed: what is printed would go into it. */
static void hold_streams(void)
{
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; stream++)
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) < 0) _exit(RUN_CANNOT_WRITE);
}

/* No destructors: they would wait for threads that are still at work. */
static void end_without_memory(void *self, const char *sentence)
{
    (void)self;
    fprintf(stderr, "slender: %s\n", sentence);
    fflush(stdout);
    ranks_abort(RUN_NO_MEMORY);
    _exit(RUN_NO_MEMORY);
}

/* Has who reads what is printed gone, as `head` does when it has enough? */
static bool is_unread(int stream)
{
    struct pollfd at = {.fd = stream, .events = POLLOUT};
    return poll(&at, 1, 0) > 0 && (at.revents & (POLLERR | POLLHUP));
}

/* What could not be printed is lost, and known only now: a full disk, a closed stream; but for what nobody wanted to read. */
static int finish(int code)
{
    bool unread = is_unread(STDOUT_FILENO), lost = fflush(stdout) != 0 || ferror(stdout);
    lost = fclose(stdout) != 0 || lost;
    lost = (lost && !unread) || ferror(stderr);
    return lost ? verb_fail(RUN_CANNOT_WRITE, "what it prints cannot be written: all of it or a part is lost")
                : code;
}

static int run_verb(int argc, char **argv)
{
    const char *name = argc > 1 ? argv[1] : "help";
    if (!strncmp(name, "--", 2)) name += 2;
    for (int k = 0; k < VERB_COUNT; k++)
        if (!strcmp(name, verbs[k].name)) return finish(verbs[k].run(argc - 1, argv + 1));
    say(stderr, "slender: there is no verb '%s'; slender help lists them", name);
    return RUN_USAGE;
}

int main(int argc, char **argv)
{
    hold_streams();
    mem_set_hook((MemHook){end_without_memory, NULL});
    signal(SIGPIPE, SIG_IGN); /* a run goes on to its result, whether its words are read or not */
    signal(SIGXFSZ, SIG_IGN); /* a file beyond the limit of sizes is what a full disk is: write says EFBIG */
    kernels_start(argv);      /* may begin the program again: before MPI */
    if (ranks_are_given()) ranks_start();
    if (ranks_serve()) return RUN_DONE;
    int code = run_verb(argc, argv);
    ranks_end();
    return code;
}
