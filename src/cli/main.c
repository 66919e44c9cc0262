/* main.c: the `hnbrdf` command: finds the subcommand and answers for what no subcommand owns. */
#include "cli/cli.h"
#include "cli/ranks.h"

#include "base/guess.h"

#include <string.h>

typedef struct subcommand {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *about;
} subcommand;

#define SUBCOMMAND(name, about) {#name, cmd_##name, about},
static const subcommand subcommands[] = {CLI_COMMANDS(SUBCOMMAND)};
enum { SUBCOMMANDS = sizeof subcommands / sizeof subcommands[0] };

static void print_overview(FILE *file)
{
    fputs("usage: hnbrdf COMMAND [arguments]\n"
          "\n"
          "Hybrid neural-microfacet BRDFs: fit them to measurements, prove them, use them in "
          "shaders.\n"
          "\n"
          "commands:\n",
          file);
    for (int k = 0; k < SUBCOMMANDS; k++)
        fprintf(file, "  %-9s  %s\n", subcommands[k].name, subcommands[k].about);
    char files[256];
    cli_measured_files(files, sizeof files, " or ");
    fprintf(file,
            "\nDATA is `builtin` or `builtin:anisotropic` (procedural materials), builtin:NAME of "
            "one,\nfiles or directories of them:\n%s.\n",
            files);
    fputs("A material is named after its file. `hnbrdf COMMAND --help` tells "
          "more.\n"
          "\n"
          "examples:\n"
          "  hnbrdf fit builtin -o model.safetensors\n"
          "  hnbrdf compare model.safetensors builtin\n"
          "  hnbrdf info model.safetensors\n"
          "  hnbrdf export model.safetensors -o scene.glsl\n"
          "  hnbrdf verify model.safetensors\n",
          file);
}

static const subcommand *find_subcommand(const char *name)
{
    for (int k = 0; k < SUBCOMMANDS; k++)
        if (strcmp(name, subcommands[k].name) == 0)
            return &subcommands[k];
    hnbrdf_guess guess;
    hnbrdf_guess_begin(&guess, name);
    for (int k = 0; k < SUBCOMMANDS; k++)
        hnbrdf_guess_offer(&guess, subcommands[k].name);
    const char *nearest = hnbrdf_guess_nearest(&guess);
    if (nearest)
        cli_fail("unknown command '%s', did you mean '%s'?", name, nearest);
    else
        cli_fail("unknown command '%s'", name);
    fputs("try: hnbrdf --help\n", stderr);
    return NULL;
}

static int show_help(int argc, char **argv)
{
    if (argc < 3) {
        print_overview(stdout);
        return CLI_OK;
    }
    const subcommand *found = find_subcommand(argv[2]);
    if (!found)
        return CLI_USAGE;
    char help[] = "--help";
    char *arguments[] = {argv[2], help, NULL};
    return found->run(2, arguments);
}

/* Whether several processes share the work of a command. */
static int runs_on_ranks(const char *name)
{
    static const char *const shared[] = {"fit", "bake", "report"};
    for (size_t k = 0; k < sizeof shared / sizeof shared[0]; k++)
        if (strcmp(name, shared[k]) == 0)
            return 1;
    return 0;
}

static int run(int argc, char **argv)
{
    if (argc < 2) {
        print_overview(stderr);
        return CLI_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        print_overview(stdout);
        return CLI_OK;
    }
    if (strcmp(argv[1], "help") == 0)
        return show_help(argc, argv);
    if (strcmp(argv[1], "--version") == 0 || strcmp(argv[1], "-V") == 0) {
        printf("hnbrdf %s\n", hnbrdf_version());
        return CLI_OK;
    }
    const subcommand *found = find_subcommand(argv[1]);
    if (!found)
        return CLI_USAGE;
    if (cli_ranks() && !runs_on_ranks(found->name))
        return cli_fail("%s is done by one process, but was started in %d; those that share their "
                        "work are fit, bake and report accuracy",
                        found->name, cli_rank_count());
    return found->run(argc - 1, argv + 1);
}

int main(int argc, char **argv)
{
    cli_standard_begin();
    const int code = cli_ranks_begin();
    return cli_ranks_end(cli_standard_end(code ? code : run(argc, argv)));
}
