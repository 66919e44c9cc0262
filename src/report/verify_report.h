/* verify_report.h: what `hnbrdf verify` found, for people and for programs. */
#ifndef HNBRDF_REPORT_VERIFY_REPORT_H
#define HNBRDF_REPORT_VERIFY_REPORT_H

#include "check/verify.h"

#include <stdio.h>

/* One device that was tried; failed holds why it could not be run, or is empty. index -1: not one
 * of the devices of this machine that are listed, but a program with a folder. */
typedef struct verified_device {
    int index;
    const char *api; /* "vulkan", "gl 330"; of a program the language */
    const char *name, *kind, *driver;
    hnbrdf_error failed;
    check_report report;
} verified_device;

typedef struct verification {
    const char *path; /* of the model */
    const hnbrdf_model *model;
    const int *materials;
    int material_count;
    size_t pairs;
    hnbrdf_glsl_weights weights;
    hnbrdf_glsl_precision precision;
    int validated, messages; /* of the validation layer */
    verified_device *devices;
    int device_count;
} verification;

/* 1 if every device is within its bounds and the validation layer said nothing. */
int verification_passed(const verification *v);

void verification_print(const verification *v, FILE *file);
/* For programs; the argument is a verification. CSV: one row a device, material, build and stage.
 */
void verification_write_csv(const void *what, FILE *file);
void verification_write_json(const void *what, FILE *file);

#endif
