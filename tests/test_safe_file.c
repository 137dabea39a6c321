/* How files are written: anew beside their place, as the user's mask says; what killed runs have left goes, what others
 * hold or have put there stays. */
#include "base/memory.h"
#include "io/mesh_file.h"
#include "io/replace.h"
#include "io/safe_file.h"
#include "io/table.h"
#include <fcntl.h>
#include <glob.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

static const char PATH[] = "test_safe_file.txt";

static int put(const char *path, const char *text)
{
    int file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0666);
    assert_true(file >= 0 && write(file, text, strlen(text)) == (ssize_t)strlen(text));
    return file;
}

static void expect(const char *path, const char *text)
{
    char got[64] = "";
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    got[fread(got, 1, sizeof got - 1, file)] = 0;
    fclose(file);
    assert_string_equal(got, text);
}

static void write_text(const char *text)
{
    Error err;
    if (!safe_file_write(PATH, text, strlen(text), false, &err)) fail_msg("%s", err.text);
    expect(PATH, text);
}

static void test_mode(void **state)
{
    (void)state;
    struct stat info;
    mode_t mask = umask(027);
    unlink(PATH);
    write_text("one");
    umask(mask);
    assert_true(stat(PATH, &info) == 0 && (info.st_mode & 0777) == 0640);
}

static void test_left_over(void **state)
{
    (void)state;
    static const char left[] = "test_safe_file.txt.slender-killed",
                      held[] = "test_safe_file.txt.slender-alive2",
                      link[] = "test_safe_file.txt.slender-linked",
                      *other = "test_safe_file.txt.slender-another", *user = "test_safe_file.txt.backup.tmp",
                      *victim = "test_safe_file.victim";
    close(put(left, "half"));
    close(put(other, "a name of its own"));
    close(put(user, "the user's"));
    close(put(victim, "precious"));
    unlink(link);
    assert_int_equal(symlink(victim, link), 0);
    int file = put(held, "half");
    assert_int_equal(flock(file, LOCK_EX), 0);
    write_text("two");
    assert_int_not_equal(access(left, F_OK), 0);
    expect(held, "half");
    expect(other, "a name of its own");
    expect(user, "the user's");
    expect(victim, "precious");
    expect(link, "precious");
    close(file);
    write_text("three");
    assert_int_not_equal(access(held, F_OK), 0);
    unlink(link), unlink(other), unlink(user), unlink(victim);
    glob_t found;
    assert_int_equal(glob("test_safe_file.txt.*", 0, NULL, &found), GLOB_NOMATCH);
}

/* By the one way, too; a journal and its parts are never replaced. */
static void test_tables_and_meshes(void **state)
{
    (void)state;
    Error err;
    double values[] = {1, 2};
    MeshFile mesh = {.vertex_count = 1, .vertices = (double[][3]){{1, 2, 3}}};
    int journal = put("test_safe_file.run", "SQLite format 3");
    assert_int_equal(write(journal, "", 1), 1); /* its closing 0 is part of the mark */
    close(journal);
    for (const char *const *part = (const char *const[]){"", "-wal", "-shm", "-lock", NULL}; *part; part++) {
        char name[64];
        snprintf(name, sizeof name, "test_safe_file.run%s", *part);
        assert_false(table_write(name, NULL, values, 1, 2, &err));
        assert_non_null(strstr(err.text, "is not overwritten: it is a run's journal"));
    }
    unlink("test_safe_file.run");
    assert_true(table_write(PATH, "# x", values, 1, 2, &err));
    expect(PATH, "# x\n1, 2\n");
    assert_true(mesh_file_write_obj(PATH, &mesh, &err));
    expect(PATH, "# made by slender " SLENDER_VERSION "\nv 1 2 3\n");
    assert_false(table_write("no/such/folder.csv", NULL, values, 1, 2, &err));
    assert_string_equal(err.text, "no/such/folder.csv: cannot be written: No such file or directory");
    assert_false(table_write("/dev/null", NULL, values, 1, 2, &err));
}

static void test_same(void **state)
{
    (void)state;
    close(put(PATH, "one"));
    unlink("test_safe_file.hard");
    assert_int_equal(link(PATH, "test_safe_file.hard"), 0);
    assert_true(replace_is_same(PATH, "./test_safe_file.txt") &&
                replace_is_same(PATH, "test_safe_file.hard"));
    assert_false(replace_is_same(PATH, "test_safe_file.none"));
    assert_true(replace_is_same("./test_safe_file.none", "test_safe_file.none"));
    unlink("test_safe_file.hard");
    unlink(PATH);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_mode), cmocka_unit_test(test_left_over),
                                       cmocka_unit_test(test_tables_and_meshes), cmocka_unit_test(test_same)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
