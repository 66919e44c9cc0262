/* exchange.h: a folder by which programs outside of this one take part: in any language and API, on
 * any device. check_hand_out() writes into it what they run and on what, check_hand_in() reads and
 * judges what came of it. src/README.md says what the files hold. */
#ifndef HNBRDF_CHECK_EXCHANGE_H
#define HNBRDF_CHECK_EXCHANGE_H

#include "check/verify.h"

enum { CHECK_DEVICE_NAME = 128 };

/* What is exported, in which language, and what is asked of it. Of options those that decide about
 * the text count: language, weights, precision, fixed, editable; the materials are those of
 * check. */
typedef struct check_exchange {
    const char *folder; /* it exists */
    hnbrdf_glsl_options options;
    check_verify_options check;
} check_exchange;

/* Writes scene, parity, inputs, probe, weights and, last, case.json. */
hnbrdf_result check_hand_out(const hnbrdf_model *model, const check_exchange *exchange,
                             hnbrdf_error *error);

/* What was found in a folder; device: the first line of device.txt, or "a program". */
typedef struct check_handed_in {
    check_exchange exchange; /* as it was handed out; check.materials is `materials` */
    int *materials;
    char device[CHECK_DEVICE_NAME];
    check_report report;
} check_handed_in;

/* HNBRDF_ERROR_FORMAT with the file if something is missing, of another size, or not what this
 * model gives. progress may be NULL. */
hnbrdf_result check_hand_in(const hnbrdf_model *model, const char *folder,
                            void (*progress)(void *user, double share), void *user,
                            check_handed_in *found, hnbrdf_error *error);
void check_handed_in_free(check_handed_in *found);

/* For the two: FOLDER/NAME.EXTENSION of the build, "scene" or "parity", and its text, malloc'ed. */
enum { CHECK_EXCHANGE_PATH = 4096 };
hnbrdf_result check_exchange_path(const char *folder, const char *name,
                                  char path[CHECK_EXCHANGE_PATH], hnbrdf_error *error);
hnbrdf_result check_exchange_scene(const hnbrdf_model *model, const check_exchange *exchange,
                                   check_build build, char **text, hnbrdf_error *error);
/* "scene.glsl", "scene_exact.glsl", ... */
void check_exchange_name(const check_exchange *exchange, const char *name, check_build build,
                         char to[64]);

#endif
