/* report.h: what the reports read alike from the command line. Those that return -1 to go on return
 * an exit code after a message otherwise, as cli_parse() does. */
#ifndef HNBRDF_CLI_REPORT_H
#define HNBRDF_CLI_REPORT_H

#include "cli/picture.h"
#include "report/grid.h"

/* `hnbrdf report images`; argv[1] is "images". */
int cmd_report_images(int argc, char **argv);
/* `hnbrdf report sampling`; argv[1] is "sampling". */
int cmd_report_sampling(int argc, char **argv);
/* `hnbrdf report editing`; argv[1] is "editing". */
int cmd_report_editing(int argc, char **argv);

int report_read_nets(const cli_command *command, const char *list, report *r);
int report_read_latents(const cli_command *command, const char *list, report *r);
int report_read_models(const cli_command *command, const char *list, report *r);
/* The command as it was typed, before cli_parse() moves its arguments about; malloc'ed, NULL when
 * memory is short. */
char *report_join(int argc, char **argv);

#endif
