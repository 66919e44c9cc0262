/* cli.h: what every subcommand of `hnbrdf` shares: options, messages, sources, progress. */
#ifndef HNBRDF_CLI_CLI_H
#define HNBRDF_CLI_CLI_H

#include "cli/commands.h"
#include "hnbrdf/edit.h"
#include "hnbrdf/hnbrdf.h"
#include "hnbrdf/measured.h"
#include "report/output.h"
#include "report/watch.h"

#include <stdio.h>

/* Exit codes: 0 done, 1 failure (bad data, out of bounds, I/O), 2 wrong usage. */
enum { CLI_OK = 0, CLI_FAILURE = 1, CLI_USAGE = 2 };

/* ---- Options ------------------------------------------------------------------------------------
 * A command describes itself once; --help, parsing and messages come from that. */
typedef enum cli_type {
    CLI_FLAG,   /* int *: set to 1 */
    CLI_TEXT,   /* const char **: points into argv */
    CLI_INT,    /* long *: decimal integer */
    CLI_REAL,   /* double *: finite decimal number, '.' whatever the locale */
    CLI_NET,    /* int[2]: HxN, as in 32x2 */
    CLI_CHOICE, /* int *: which word of `argument`, "a|b|c", from 0 */
    CLI_WORD,   /* cli_word *: the value with this name */
    CLI_TABLE,  /* const cli_option *: the options of another table, here among these */
    CLI_READ,   /* const char **: a file that is read */
    /* Each const char **: what is written; cli_parse() checks it before any work, see files.c. */
    CLI_WRITE_TEXT,    /* "-" is standard output */
    CLI_WRITE_BYTES,   /* likewise */
    CLI_WRITE_MODEL,   /* may be a model that is read */
    CLI_WRITE_PICTURE, /* FILE.exr and the FILE.png beside it, or FILE.png */
    CLI_WRITE_FOLDER
} cli_type;

/* A value of an enum that counts from 0, and the names of all: NULL past the last. */
typedef struct cli_word {
    int value;
    const char *(*name)(int value);
} cli_word;

typedef struct cli_option {
    const char *name; /* long name without "--"; NULL ends the table */
    char letter;      /* short name, or 0 */
    cli_type type;
    void *value;
    double low, high;     /* accepted range of CLI_INT and CLI_REAL; both 0: any */
    const char *argument; /* name of the argument in the help: "N", "FILE" ... */
    const char *help;     /* one line; say the default and the unit */
} cli_option;

typedef struct cli_command {
    const char *name;     /* "fit" */
    const char *synopsis; /* "DATA... [options] -o MODEL.safetensors" */
    const char *about;    /* a few lines */
    const char *examples; /* lines that can be pasted; --help indents them */
} cli_command;

/* Parses argv[1..]. `--name value`, `--name=value`, `-o value`; "--" ends options; "-" is
 * positional. Positionals are moved to argv[1..*positionals] in order. Returns -1 to go on;
 * otherwise the exit code the command must return (0 after --help, 2 after an error, whose
 * message has been printed). An option that takes a value is given once. What is to be written can
 * be written, is not written twice, and is nothing that is read. */
int cli_parse(const cli_command *command, const cli_option *options, int argc, char **argv,
              int *positionals);

/* Option k of a table and of the tables in it, or NULL past the last. */
const cli_option *cli_option_at(const cli_option *options, int k);
/* What cli_parse() asks about files when it knows all: -1 to go on, or the exit code. */
int cli_check_files(const cli_command *command, const cli_option *options, char *const *arguments,
                    int count);
/* For a file that no argument names, as one in a folder: does an option of this command write it?
 * Then a message and CLI_FAILURE. */
int cli_check_read(const char *path);

/* Prints "hnbrdf COMMAND: message" and a hint to --help on stderr; returns CLI_USAGE. */
int cli_usage(const cli_command *command, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Prints "hnbrdf: message" on stderr, always one line; returns CLI_FAILURE. */
int cli_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* The same after "hnbrdf: warning: ". */
void cli_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* Warns of what a reader tells: the function of an hnbrdf_notes. */
void cli_note(void *user, const char *line);
/* The line printed last by one of these; "" before. */
const char *cli_last_message(void);
#define CLI_NOTES      \
    {                  \
        cli_note, NULL \
    }

/* HxN, as in 32x2, at the start of text: H units in each of N hidden layers. Returns where it ends,
 * NULL if it is none or too large; net is then untouched. */
const char *cli_parse_net(const char *text, int net[2]);

/* A decimal number that is the whole text and finite, '.' whatever the locale: 1, else 0. */
int cli_parse_real(const char *text, double *value);

/* What a 0 for --threads stands for: the processors that are online. */
int cli_processors(void);

/* ---- Reading measured files ------------------------------------------------------------------ */

/* The reading options that the command line gave; they hold for every file the process opens. Each
 * such command has CLI_READING_OPTIONS in its table: those of the library's table of formats.
 * merl_identify is no option: for commands that tell about files. */
extern hnbrdf_measured_options cli_read;
/* The options without, or only, those that make negative values. */
const cli_option *cli_reading_table(int negative);
/* A line on stdout with the options that are not the default; nothing if all are. */
void cli_print_reading(void);
/* "RGL .bsdf, MERL .binary or UTIA .bin", with `last` (" or ") before the last. */
void cli_measured_files(char *text, size_t size, const char *last);

/* A row of an option table that stands for another table. */
cli_option cli_table_option(const cli_option *table);
#define CLI_READING_OPTIONS cli_table_option(cli_reading_table(0))
/* Not for `fit`: a model is never negative. */
#define CLI_SIGNED_OPTION cli_table_option(cli_reading_table(1))

/* ---- Sources and data ------------------------------------------------------------------------ */

/* DATA arguments: "builtin" and "builtin:anisotropic" (the two sets of built-in materials),
 * "builtin:NAME", "procedural:N" (the first N procedural materials), files, or directories (every
 * file in them with the ending of a measured format, in byte order of their names). */
typedef struct cli_data {
    hnbrdf_measured **items;
    int count;
} cli_data;

/* Opens all; two materials of one name are an error. Returns 0, or CLI_FAILURE after a message. */
int cli_open_data(char *const *arguments, int count, cli_data *data);
/* Does the argument stand for any number of materials? */
int cli_is_collection(const char *argument);
/* The same as cli_open_data() of several processes: each opens its share, items of the others are
 * NULL. An error of one is one of all. */
int cli_open_data_of_ranks(char *const *arguments, int count, cli_data *data);
void cli_close_data(cli_data *data);

/* A SOURCE is a model file or one measured material (file or "builtin:NAME"): exactly one is set.
 * */
typedef struct cli_source {
    hnbrdf_model *model;
    hnbrdf_measured *measured;
} cli_source;

/* Which instructions models are evaluated with; all give the same bits. */
extern cli_word cli_variant;

/* By its first bytes. */
int cli_looks_like_model(const char *path);
/* Whether it is the word for the shipped network, which needs no file; a file of that name is
 * ./universal. */
int cli_is_universal(const char *path);
/* Recognised by content. Returns 0, or CLI_FAILURE after a message. */
int cli_open_source(const char *path, cli_source *source);
void cli_close_source(cli_source *source);
/* The number of the material to use: as cli_choose_material() for a model; 0 for a measured file,
 * whose name must then be `name` or name NULL. -1 after a message. */
int cli_choose_source_material(const cli_source *source, const char *name);

/* A model file and nothing else. Returns 0, or CLI_FAILURE after a message. */
int cli_open_model(const char *path, hnbrdf_model **model);
/* Of published shaders: how many names lost what published names add, and the number of the first
 * of them, from 1. */
typedef struct cli_imported {
    int renamed, first;
} cli_imported;
/* Published .brdf shaders, count >= 1, of the same network. */
int cli_import(char *const *paths, int count, hnbrdf_model **model, cli_imported *told);
/* All shaders of a folder, or a model file made of them. */
int cli_open_published(const char *path, hnbrdf_model **model);
/* The same for a command that writes it to `output`, which may be `path`: asks, before any work,
 * whether that can be written. */
int cli_open_model_to_change(const char *path, const char *output, hnbrdf_model **model);
/* The message for a new name that a material of the model has; returns CLI_FAILURE. */
int cli_fail_name_taken(const char *path, const char *name);
/* Puts a model whose materials have lobes of this scheme in the place of *model, which is freed;
 * on failure it stays. Shows progress. Returns 0, or CLI_FAILURE after a message. */
int cli_set_lobes(hnbrdf_model **model, hnbrdf_lobes_scheme scheme);

/* Index of the material to use: by name; with name NULL the only one (several: a message listing
 * them). -1 after a message. */
int cli_choose_material(const hnbrdf_model *model, const char *name);
/* "A,B,C" to indices, NULL to all; *indices is malloc'ed. Returns 0, or CLI_FAILURE after a
 * message. */
int cli_choose_materials(const hnbrdf_model *model, const char *list, int **indices, int *count);

/* ---- Output -------------------------------------------------------------------------------------
 * As report/output.h has it, with a message where it fails. Each: 0, or CLI_FAILURE. */
typedef report_output cli_output;
int cli_output_open(const char *path, cli_output *output);
int cli_output_close(cli_output *output);    /* flush, check, rename */
int cli_output_check(const char *path);      /* can it be written? before long work; NULL: yes */
void cli_output_discard(cli_output *output); /* drop what was written */
int cli_make_folder(const char *path);       /* unless it is there */
/* Opens, writes and closes; nothing if path is NULL. */
int cli_write_file(const char *path, void (*write)(const void *what, FILE *file), const void *what);
/* Standard input, output and error for a process that was given some of them closed; what becomes
 * of a reader of stdout that is gone and of a file that may not grow. The end flushes stdout and
 * returns the exit code. */
void cli_standard_begin(void);
int cli_standard_end(int code);
int cli_standard_gone(void); /* 1 after a write to a pipe that nobody reads */
/* 1 if path is "-". */
int cli_is_stdout(const char *path);
/* Where words for a person go: stdout, or stderr once an option has given stdout to data. */
FILE *cli_words(void);
void cli_give_stdout_to_data(void);

/* ---- Progress -----------------------------------------------------------------------------------
 * One line  * on stderr, rewritten in place on a terminal, a line every 10 s elsewhere; nothing
 * for anything  * that ends within 2 s. share is 0 to 1. Call as often as you like. */
typedef struct cli_progress {
    double started, shown;
    const char *what;
} cli_progress;
void cli_progress_begin(cli_progress *progress, const char *what);
void cli_progress_update(cli_progress *progress, double share, const char *detail);
void cli_progress_end(cli_progress *progress);
/* cli_progress_update() as a callback of the library: never stops it. */
int cli_progress_show(void *progress, double share, const char *detail);
/* A line for each of several pieces of work that follow each other, called by what they do.
 * Zero-initialise. */
typedef struct cli_stages {
    cli_progress line;
    char what[112]; /* "": no line */
} cli_stages;
void cli_stages_show(cli_stages *stages, const char *what, double share, const char *detail);
void cli_stages_end(cli_stages *stages); /* before anything else is printed */
/* Monotonic seconds. */
double cli_seconds(void);

/* For functions that show how far they are on this line and stop when interrupted. */
report_watch cli_watch(cli_progress *progress);
/* The exit code for a result, after its message. */
int cli_code(hnbrdf_result result, const hnbrdf_error *error);

#endif
