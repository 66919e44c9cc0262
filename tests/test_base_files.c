/* test_base_files.c: a file is complete or what it was before, whoever writes it at the same time;
 * links, modes, pipes and leftovers. */
#include "base/files.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

static char directory[] = "/tmp/hnbrdf_files_XXXXXX";

static int set_up(void **state)
{
    (void)state;
    return mkdtemp(directory) == NULL || chdir(directory) != 0;
}

static int tear_down(void **state)
{
    (void)state;
    return chdir("/") != 0 || rmdir(directory) != 0; /* nothing is left aside by anyone */
}

static void write_text(const char *path, const char *text)
{
    hnbrdf_error error = {""};
    if (hnbrdf_write_file(path, text, strlen(text), &error))
        fail_msg("%s", error.text);
}

static void assert_text(const char *path, const char *text)
{
    char found[256] = "";
    FILE *file = hnbrdf_open_to_read(path);
    assert_non_null(file);
    found[fread(found, 1, sizeof found - 1, file)] = '\0';
    fclose(file);
    assert_string_equal(found, text);
}

static unsigned mode_of(const char *path)
{
    struct stat status;
    assert_int_equal(lstat(path, &status), 0);
    return status.st_mode & 07777;
}

static int exists(const char *path)
{
    struct stat status;
    return lstat(path, &status) == 0;
}

/* ---- What stays ------------------------------------------------------------------------------ */

static void a_new_file_gets_what_the_umask_leaves(void **state)
{
    (void)state;
    const mode_t before = umask(027);
    write_text("new", "1");
    umask(before);
    assert_int_equal(mode_of("new"), 0640);
    remove("new");
}

static void a_replaced_file_keeps_its_mode(void **state)
{
    static const unsigned modes[] = {0600, 0644, 0755, 0660, 0200};
    (void)state;
    for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++) {
        write_text("old", "before");
        assert_int_equal(chmod("old", (mode_t)modes[i]), 0);
        write_text("old", "after");
        assert_int_equal(mode_of("old"), modes[i]);
        chmod("old", 0600);
        assert_text("old", "after");
        remove("old");
    }
}

/* Its folder would allow to replace it; whoever made it read-only wants to keep it. */
static void a_read_only_file_is_refused(void **state)
{
    hnbrdf_error error = {""};
    int status;
    (void)state;
    write_text("kept", "before");
    assert_int_equal(chmod("kept", 0444), 0);
    assert_int_equal(chmod(".", 0777), 0);
    const pid_t child = fork();
    if (child == 0) { /* root may write to any file: as nobody */
        if (geteuid() == 0 && setuid(65534) != 0)
            _exit(2);
        _exit(hnbrdf_output_check("kept", &error) == HNBRDF_ERROR_IO &&
                      hnbrdf_write_file("kept", "after", 5, &error) == HNBRDF_ERROR_IO &&
                      strcmp(error.text, "kept: cannot write: Permission denied") == 0
                  ? 0
                  : 1);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(chmod(".", 0700), 0);
    assert_true(WIFEXITED(status));
    assert_text("kept", "before");
    remove("kept");
    if (WEXITSTATUS(status) == 2)
        skip(); /* a place without that user */
    assert_int_equal(WEXITSTATUS(status), 0);
}

static void a_replaced_file_keeps_its_owner(void **state)
{
    struct stat status;
    (void)state;
    write_text("old", "before");
    if (chown("old", 12345, 23456) != 0) {
        remove("old");
        skip(); /* only root may give files away */
    }
    write_text("old", "after");
    assert_int_equal(stat("old", &status), 0);
    assert_int_equal(status.st_uid, 12345);
    assert_int_equal(status.st_gid, 23456);
    remove("old");
}

static void a_symbolic_link_stays_and_its_target_is_replaced(void **state)
{
    char text[64] = "";
    (void)state;
    assert_int_equal(mkdir("folder", 0700), 0);
    assert_int_equal(symlink("folder/second", "first"), 0);
    assert_int_equal(symlink("../target", "folder/second"), 0);
    for (int k = 0; k < 2; k++) { /* a link that names nothing yet, then one that does */
        write_text("first", k ? "2" : "1");
        assert_int_equal(readlink("first", text, sizeof text), strlen("folder/second"));
        assert_int_equal(readlink("folder/second", text, sizeof text), strlen("../target"));
        assert_text("target", k ? "2" : "1");
    }
    assert_int_equal(symlink("ring", "ring"), 0);
    assert_int_equal(hnbrdf_write_file("ring", "", 0, NULL), HNBRDF_ERROR_IO);
    remove("ring");
    remove("first");
    remove("folder/second");
    remove("target");
    assert_int_equal(rmdir("folder"), 0);
}

static void a_pipe_is_written_as_it_is(void **state)
{
    int status;
    (void)state;
    assert_int_equal(mkfifo("pipe", 0600), 0);
    assert_int_equal(hnbrdf_output_check("pipe", NULL), HNBRDF_OK); /* and does not wait */
    const pid_t child = fork();
    if (child == 0)
        _exit(hnbrdf_write_file("pipe", "through", 7, NULL) != HNBRDF_OK);
    assert_text("pipe", "through");
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    assert_true(exists("pipe"));
    remove("pipe");
}

/* ---- Who else writes ------------------------------------------------------------------------- */

static void outputs_that_are_open_together_do_not_mix(void **state)
{
    enum { COUNT = 5 };
    static hnbrdf_output outputs[COUNT];
    (void)state;
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(hnbrdf_output_open("shared", &outputs[i], NULL), HNBRDF_OK);
    for (int round = 0; round < 3; round++)
        for (int i = 0; i < COUNT; i++) {
            fprintf(outputs[i].stream, "%d", i);
            fflush(outputs[i].stream);
        }
    hnbrdf_output_discard(&outputs[1]);
    for (int i = 0; i < COUNT; i++) {
        char text[4];
        if (i == 1)
            continue;
        assert_int_equal(hnbrdf_output_close(&outputs[i], NULL), HNBRDF_OK);
        snprintf(text, sizeof text, "%d%d%d", i, i, i);
        assert_text("shared", text);
    }
    remove("shared");
}

static void processes_that_write_one_file_do_not_mix(void **state)
{
    enum { PROCESSES = 4, WRITES = 200, LENGTH = 100 };
    pid_t children[PROCESSES];
    (void)state;
    write_text("shared", "");
    for (int i = 0; i < PROCESSES; i++) {
        children[i] = fork();
        if (children[i] == 0) {
            char text[LENGTH];
            int failed = 0;
            memset(text, 'a' + i, sizeof text);
            for (int k = 0; k < WRITES; k++)
                failed |= hnbrdf_write_file("shared", text, sizeof text, NULL) != HNBRDF_OK;
            _exit(failed);
        }
    }
    for (int k = 0; k < WRITES; k++) {
        char found[LENGTH + 1] = "";
        FILE *file = hnbrdf_open_to_read("shared");
        assert_non_null(file);
        const size_t length = fread(found, 1, LENGTH, file);
        fclose(file);
        assert_true(length == 0 || length == LENGTH);
        assert_true(strspn(found, (char[2]){found[0], '\0'}) == length);
    }
    for (int i = 0; i < PROCESSES; i++) {
        int status;
        assert_int_equal(waitpid(children[i], &status, 0), children[i]);
        assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    }
    remove("shared");
}

/* ---- What is in the way ---------------------------------------------------------------------- */

static void a_leftover_of_a_killed_process_is_removed(void **state)
{
    int status;
    (void)state;
    const pid_t child = fork();
    if (child == 0) {
        static hnbrdf_output output;
        if (hnbrdf_output_open("file", &output, NULL))
            _exit(1);
        fputs("half of", output.stream);
        fflush(output.stream);
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(exists("file" HNBRDF_ASIDE));
    write_text("file", "whole");
    assert_text("file", "whole");
    assert_false(exists("file" HNBRDF_ASIDE));
    remove("file");
}

static void what_is_no_leftover_stays(void **state)
{
    (void)state;
    write_text("other", "precious");
    assert_int_equal(symlink("other", "file" HNBRDF_ASIDE), 0);
    assert_int_equal(mkdir("file" HNBRDF_ASIDE "1", 0700), 0);
    write_text("file", "whole");
    assert_text("file", "whole");
    assert_text("other", "precious");
    assert_true(exists("file" HNBRDF_ASIDE));
    assert_int_equal(rmdir("file" HNBRDF_ASIDE "1"), 0);
    remove("file" HNBRDF_ASIDE);
    remove("file");
    remove("other");
}

static void a_place_that_takes_no_file_is_named_before_the_work(void **state)
{
    hnbrdf_error error = {""};
    (void)state;
    assert_int_equal(hnbrdf_output_check("missing/file", &error), HNBRDF_ERROR_IO);
    assert_string_equal(error.text, "missing/file: cannot write: No such file or directory");
    assert_int_equal(hnbrdf_output_check(".", &error), HNBRDF_ERROR_IO);
    assert_string_equal(error.text, ".: cannot write: Is a directory");
    assert_int_equal(hnbrdf_output_check("file", &error), HNBRDF_OK);
    assert_false(exists("file"));
    assert_false(exists("file" HNBRDF_ASIDE));
    char path[HNBRDF_PATH_SIZE + 1];
    memset(path, 'x', sizeof path);
    path[HNBRDF_PATH_SIZE] = '\0';
    assert_int_equal(hnbrdf_output_check(path, NULL), HNBRDF_ERROR_IO);

    assert_int_equal(mkdir("closed", 0700), 0);
    write_text("closed/file", "old");
    assert_int_equal(chmod("closed", 0500), 0);
    const int refused = hnbrdf_output_check("closed/file", &error) != HNBRDF_OK;
    assert_int_equal(chmod("closed", 0700), 0);
    assert_text("closed/file", "old");
    remove("closed/file");
    assert_int_equal(rmdir("closed"), 0);
    if (geteuid() == 0)
        skip(); /* root may write anywhere */
    assert_true(refused);
    assert_string_equal(error.text, "closed/file: cannot write: Permission denied: the folder "
                                    "'closed' lets no file be made in it");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_file_gets_what_the_umask_leaves),
        cmocka_unit_test(a_replaced_file_keeps_its_mode),
        cmocka_unit_test(a_read_only_file_is_refused),
        cmocka_unit_test(a_replaced_file_keeps_its_owner),
        cmocka_unit_test(a_symbolic_link_stays_and_its_target_is_replaced),
        cmocka_unit_test(a_pipe_is_written_as_it_is),
        cmocka_unit_test(outputs_that_are_open_together_do_not_mix),
        cmocka_unit_test(processes_that_write_one_file_do_not_mix),
        cmocka_unit_test(a_leftover_of_a_killed_process_is_removed),
        cmocka_unit_test(what_is_no_leftover_stays),
        cmocka_unit_test(a_place_that_takes_no_file_is_named_before_the_work),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
