/* words.h: the names of the library's enums, as options take them: each the name of a value, NULL
 * past the last. For a cli_word. */
#ifndef HNBRDF_CLI_WORDS_H
#define HNBRDF_CLI_WORDS_H

const char *cli_kind_word(int value);
const char *cli_sampler_word(int value);
const char *cli_encoding_word(int value);
const char *cli_variant_word(int value);
const char *cli_weights_word(int value);
const char *cli_precision_word(int value);
const char *cli_language_word(int value);
const char *cli_analytic_word(int value);
const char *cli_loss_word(int value);
const char *cli_schedule_word(int value);

#endif
