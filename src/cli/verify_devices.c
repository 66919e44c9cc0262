/* verify_devices.c: `hnbrdf verify` on the devices of this machine: opens what there is of each API
 * and runs the scene on it. */
#include "cli/verify_devices.h"

#include "cli/cli.h"

#ifdef HNBRDF_WITH_VULKAN
#include "gpu/verify.h"
#endif
#ifdef HNBRDF_WITH_EGL
#include "gl/verify.h"
#endif

#include <stdlib.h>
#include <string.h>

void verify_free_devices(verification *v)
{
    for (int d = 0; d < v->device_count; d++) {
        check_report_free(&v->devices[d].report);
        free((char *)v->devices[d].name);
        free((char *)v->devices[d].kind);
        free((char *)v->devices[d].driver);
    }
    free(v->devices);
}

#if defined(HNBRDF_WITH_VULKAN) || defined(HNBRDF_WITH_EGL)

static void on_progress(void *user, double share)
{
    cli_progress_update(user, share, "");
}

/* Room for one more; NULL after a message. Names are copied, as drivers are unloaded. */
static verified_device *add_device(verification *v, int index, const char *api, const char *name,
                                   const char *kind, const char *driver)
{
    verified_device *grown =
        realloc(v->devices, ((size_t)v->device_count + 1) * sizeof *v->devices);
    if (!grown) {
        cli_fail("out of memory");
        return NULL;
    }
    v->devices = grown;
    verified_device *to = &grown[v->device_count++];
    *to = (verified_device){.index = index, .api = api};
    to->name = strdup(name);
    to->kind = strdup(kind);
    to->driver = strdup(driver);
    if (to->name && to->kind && to->driver)
        return to;
    cli_fail("out of memory");
    return NULL;
}

/* Which of `count` devices are meant. 0, or CLI_FAILURE after a message. */
static int choose(int device, int count, const char *api, const char *package, int *first,
                  int *after)
{
    if (count == 0)
        return cli_fail("no %s device found (Debian: apt-get install %s brings one in software)",
                        api, package);
    if (device >= count)
        return cli_fail("--device %d: %s has devices 0 to %d here (hnbrdf verify --list)", device,
                        api, count - 1);
    *first = device < 0 ? 0 : device;
    *after = device < 0 ? count : device + 1;
    return CLI_OK;
}

#endif

/* ---- Vulkan ---------------------------------------------------------------------------------- */

#ifdef HNBRDF_WITH_VULKAN

static int open_vulkan(int validate, gpu_instance *instance)
{
    hnbrdf_error error;
    return cli_code(gpu_open(validate ? GPU_VALIDATED_SYNC : GPU_NOT_VALIDATED, instance, &error),
                    &error);
}

static int list_vulkan(int validate)
{
    gpu_instance instance;
    if (open_vulkan(validate, &instance) != CLI_OK)
        return CLI_FAILURE;
    for (int i = 0; i < instance.count; i++)
        printf("vulkan %d: %s, %s, %s\n", i, instance.properties[i].deviceName,
               gpu_kind_name(&instance, i), instance.drivers[i]);
    gpu_close(&instance);
    return CLI_OK;
}

static int run_vulkan_device(const gpu_instance *instance, int index, const verify_job *job,
                             verification *v)
{
    cli_progress progress;
    gpu_device device;
    gpu_verify_options options = {.scene = {job->text, job->weights->bytes, job->weights->size},
                                  .check = job->exchange.check,
                                  .stage = job->fragment ? GPU_STAGE_FRAGMENT : GPU_STAGE_COMPUTE,
                                  .without_timing = job->without_timing};
    options.check.progress = on_progress;
    options.check.progress_user = &progress;
    verified_device *to = add_device(v, index, job->fragment ? "vulkan fragment" : "vulkan",
                                     instance->properties[index].deviceName,
                                     gpu_kind_name(instance, index), instance->drivers[index]);
    if (!to)
        return CLI_FAILURE;
    if (gpu_device_open(instance, index, &device, &to->failed))
        return CLI_OK;
    cli_progress_begin(&progress, to->name);
    if (gpu_verify(&device, v->model, &options, &to->report, &to->failed) == HNBRDF_OK)
        to->failed.text[0] = '\0';
    cli_progress_end(&progress);
    gpu_device_close(&device);
    return CLI_OK;
}

static int run_vulkan(const verify_job *job, verification *v)
{
    gpu_instance instance;
    int first = 0, after = 0;
    if (open_vulkan(job->validate, &instance) != CLI_OK)
        return CLI_FAILURE;
    int result =
        choose(job->device, instance.count, "Vulkan", "mesa-vulkan-drivers", &first, &after);
    for (int i = first; result == CLI_OK && i < after; i++)
        result = run_vulkan_device(&instance, i, job, v);
    v->messages += instance.messages;
    gpu_close(&instance);
    return result;
}

#else

static int list_vulkan(int validate)
{
    (void)validate;
    return cli_fail("verify: this hnbrdf was built without Vulkan (HNBRDF_WITH_VULKAN)");
}

static int run_vulkan(const verify_job *job, verification *v)
{
    (void)v;
    return list_vulkan(job->validate);
}

#endif

/* ---- GL and GL ES ---------------------------------------------------------------------------- */

#ifdef HNBRDF_WITH_EGL

/* A device here is a display with a dialect that it offers. */
typedef struct gl_place {
    int display;
    gl_dialect dialect;
    char name[GL_NAME], version[GL_NAME];
} gl_place;

enum { GL_PLACES = GL_MAX_DISPLAYS * GL_DIALECTS };

static int find_places(const gl_instance *instance, verify_api api, gl_place places[GL_PLACES])
{
    int count = 0;
    for (int display = 0; display < instance->count; display++)
        for (int d = 0; d < GL_DIALECTS; d++) {
            const gl_dialect dialect = (gl_dialect)d;
            gl_context context;
            if (gl_dialect_is_es(dialect) != (api == VERIFY_GLES) ||
                gl_context_open(instance, display, dialect, &context, NULL))
                continue;
            places[count] = (gl_place){.display = display, .dialect = dialect};
            memcpy(places[count].name, context.name, GL_NAME);
            memcpy(places[count++].version, context.version, GL_NAME);
            gl_context_close(&context);
        }
    return count;
}

static int list_gl(verify_api api)
{
    gl_instance instance;
    gl_place places[GL_PLACES];
    gl_open(&instance);
    int count = find_places(&instance, api, places);
    for (int i = 0; i < count; i++)
        printf("%s %d: %s, as %s, %s\n", api == VERIFY_GLES ? "gles" : "gl", i, places[i].name,
               gl_dialect_name(places[i].dialect), places[i].version);
    gl_close(&instance);
    return CLI_OK;
}

static int run_place(const gl_instance *instance, const gl_place *place, int index,
                     const verify_job *job, verification *v)
{
    cli_progress progress;
    gl_context context;
    gl_verify_options options = {.text = job->text,
                                 .weights = job->weights->bytes,
                                 .weights_size = job->weights->size,
                                 .check = job->exchange.check,
                                 .without_timing = job->without_timing};
    options.check.progress = on_progress;
    options.check.progress_user = &progress;
    verified_device *to = add_device(v, index, gl_dialect_name(place->dialect), place->name,
                                     "fragment shader", place->version);
    if (!to)
        return CLI_FAILURE;
    if (gl_context_open(instance, place->display, place->dialect, &context, &to->failed))
        return CLI_OK;
    cli_progress_begin(&progress, to->api);
    if (gl_verify(&context, v->model, &options, &to->report, &to->failed) == HNBRDF_OK)
        to->failed.text[0] = '\0';
    cli_progress_end(&progress);
    gl_context_close(&context);
    return CLI_OK;
}

static int run_gl(verify_api api, const verify_job *job, verification *v)
{
    gl_instance instance;
    gl_place places[GL_PLACES];
    int first = 0, after = 0;
    gl_open(&instance);
    int count = find_places(&instance, api, places);
    int result = choose(job->device, count, api == VERIFY_GLES ? "GL ES" : "GL", "libegl-mesa0",
                        &first, &after);
    for (int i = first; result == CLI_OK && i < after; i++)
        result = run_place(&instance, &places[i], i, job, v);
    gl_close(&instance);
    return result;
}

#else

static int list_gl(verify_api api)
{
    (void)api;
    return cli_fail("verify: this hnbrdf was built without OpenGL (HNBRDF_WITH_EGL)");
}

static int run_gl(verify_api api, const verify_job *job, verification *v)
{
    (void)job;
    (void)v;
    return list_gl(api);
}

#endif

/* ---- Any ------------------------------------------------------------------------------------- */

/* Of all, those that this command was built with. */
static int is_built(verify_api api)
{
#ifdef HNBRDF_WITH_VULKAN
    if (api == VERIFY_VULKAN)
        return 1;
#endif
#ifdef HNBRDF_WITH_EGL
    if (api != VERIFY_VULKAN)
        return 1;
#endif
    return api == VERIFY_APIS;
}

int verify_list_devices(verify_api api, int validate)
{
    int result = CLI_OK, any = 0;
    if (api != VERIFY_ALL)
        return api == VERIFY_VULKAN ? list_vulkan(validate) : list_gl(api);
    for (int each = 0; each < VERIFY_APIS && result == CLI_OK; each++)
        if (is_built((verify_api)each)) {
            any = 1;
            result = verify_list_devices((verify_api)each, validate);
        }
    return any ? result
               : cli_fail("verify: this hnbrdf was built without Vulkan and without OpenGL");
}

int verify_on_devices(verify_api api, const verify_job *job, verification *v)
{
    int result = CLI_OK, any = 0;
    if (api != VERIFY_ALL)
        return api == VERIFY_VULKAN ? run_vulkan(job, v) : run_gl(api, job, v);
    for (int each = 0; each < VERIFY_APIS && result == CLI_OK; each++)
        if (is_built((verify_api)each)) {
            any = 1;
            result = verify_on_devices((verify_api)each, job, v);
        }
    return any ? result
               : cli_fail("verify: this hnbrdf was built without Vulkan and without OpenGL");
}
