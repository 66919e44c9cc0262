/* option.c: the table of options of a command, with the tables in it. */
#include "cli/cli.h"

cli_option cli_table_option(const cli_option *table)
{
    return (cli_option){.name = "", .type = CLI_TABLE, .value = (void *)table};
}

const cli_option *cli_option_at(const cli_option *options, int k)
{
    for (const cli_option *option = options; option->name; option++) {
        const cli_option *inside = option->type == CLI_TABLE ? option->value : NULL;
        if (!inside && k-- == 0)
            return option;
        for (; inside && inside->name; inside++)
            if (k-- == 0)
                return inside;
    }
    return NULL;
}
