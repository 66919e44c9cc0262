/* verify_devices.h: `hnbrdf verify` on the devices of this machine, by every API it was built
 * with. */
#ifndef HNBRDF_CLI_VERIFY_DEVICES_H
#define HNBRDF_CLI_VERIFY_DEVICES_H

#include "base/text_buffer.h"
#include "check/exchange.h"
#include "report/verify_report.h"

/* Also the order of the choices of --api; what is listed and run for all. */
typedef enum verify_api {
    VERIFY_VULKAN = 0,
    VERIFY_GL,   /* GL 3.3 and 4.5 core */
    VERIFY_GLES, /* GL ES 3.0 and 3.2 */
    VERIFY_APIS,
    VERIFY_ALL = VERIFY_APIS
} verify_api;

typedef struct verify_job {
    check_exchange exchange; /* the folder is not used */
    const char *text;        /* of the scene, standalone */
    const hnbrdf_text_buffer *weights;
    int device;   /* number among those of its API; -1: all */
    int fragment; /* Vulkan: the fragment stage instead of compute */
    int validate, without_timing;
} verify_job;

/* A line a device: API, number, name. 0, or CLI_FAILURE after a message. */
int verify_list_devices(verify_api api, int validate);

/* Adds to v->devices, which is realloc'ed, what became of each. 0, or CLI_FAILURE after a message,
 * also where there is no device of this number or none at all. */
int verify_on_devices(verify_api api, const verify_job *job, verification *v);
void verify_free_devices(verification *v);

#endif
