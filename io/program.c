#include "io/program.h"
#include "base/memory.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* ---- Folders ---- */

bool program_folder(char **folder, Error *err)
{
    const char *where = getenv("TMPDIR");
    *folder = mem_format("%s/slender-XXXXXX", where && where[0] ? where : "/tmp");
    if (mkdtemp(*folder)) return true;
    error_set(err, "%s: no temporary folder can be made there: %s", *folder, strerror(errno));
    mem_free(*folder);
    *folder = NULL;
    return false;
}

void program_remove_folder(char *folder)
{
    if (!folder) return;
    DIR *files = opendir(folder);
    for (struct dirent *file; files && (file = readdir(files));) unlinkat(dirfd(files), file->d_name, 0);
    if (files) closedir(files);
    rmdir(folder);
    mem_free(folder);
}

/* ---- Running ---- */

void program_last_line(const char *path, char *line, int size)
{
    char next[400];
    FILE *file = fopen(path, "r");
    line[0] = 0;
    while (file && fgets(next, sizeof next, file)) {
        next[strcspn(next, "\r\n")] = 0;
        if (strspn(next, " \t") < strlen(next)) snprintf(line, (size_t)size, "%.*s", size - 1, next);
    }
    if (file) fclose(file);
}

int program_start(const char *const *arguments, const char *log, int keep, pid_t *process)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, log, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    if (keep >= 0) {
        posix_spawn_file_actions_adddup2(&actions, keep, keep); /* closes no more on exec */
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    }
    int failed =
        posix_spawnp(process, arguments[0], &actions, &attributes, (char *const *)arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    return failed;
}

bool program_run(const char *const *arguments, const char *folder, const char *advice, Error *err)
{
    pid_t process;
    int status = 0;
    char said[400], *log = mem_format("%s/log", folder);
    int failed = program_start(arguments, log, -1, &process);
    while (!failed && waitpid(process, &status, 0) < 0)
        if (errno != EINTR) failed = errno;
    if (!failed && WIFEXITED(status) && WEXITSTATUS(status) == 127)
        failed =
            ENOENT; /* POSIX: where posix_spawn could not say it, or a shell did not find what it was to run */
    program_last_line(log, said, sizeof said);
    mem_free(log);
    if (failed == ENOENT)
        return error_set(err, "the program %s is not installed (not in PATH): %s", arguments[0], advice);
    if (failed) return error_set(err, "the program %s cannot be run: %s", arguments[0], strerror(failed));
    if (WIFSIGNALED(status))
        return error_set(err, "the program %s was ended by signal %d", arguments[0], WTERMSIG(status));
    if (WEXITSTATUS(status))
        return error_set(err, "the program %s ended with code %d%s%s", arguments[0], WEXITSTATUS(status),
                         said[0] ? ": " : "", said);
    return true;
}
