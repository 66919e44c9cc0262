/* spheres.c: what pages of spheres share: the light, the measurements beside, progress. */
#include "report/spheres.h"
#include "base/text.h"

#include "report/output.h"

#include <stdlib.h>
#include <string.h>

hnbrdf_result report_spheres_open(report_spheres *spheres, hnbrdf_error *error)
{
    hnbrdf_result result = report_open_light(&spheres->light, &spheres->environment, error);
    return result ? result : render_guide_model(&spheres->guide, error);
}

void report_spheres_close(report_spheres *spheres)
{
    render_environment_free(&spheres->environment);
    hnbrdf_model_free(spheres->guide);
    spheres->guide = NULL;
}

const hnbrdf_measured *report_spheres_find(const report_spheres *spheres, const char *name)
{
    for (int k = 0; k < spheres->data_count; k++)
        if (strcmp(hnbrdf_measured_name(spheres->data[k]), name) == 0)
            return spheres->data[k];
    return NULL;
}

static int show(void *user, double share)
{
    const report_spheres *s = user;
    report_show(&s->watch, (s->first + share) / s->count, s->detail);
    return report_stop(&s->watch);
}

hnbrdf_result report_spheres_render(report_spheres *spheres, const render_surface *surface,
                                    render_image *image, hnbrdf_error *error)
{
    const render_options options = {.size = (int)spheres->size,
                                    .spp = (int)spheres->light.spp,
                                    .seed = (uint64_t)spheres->light.seed,
                                    .threads = (int)spheres->light.threads,
                                    .progress = show,
                                    .progress_user = spheres};
    return render_sphere(surface, &spheres->environment, &options, image, error);
}

hnbrdf_result report_write_told(const render_image *image, const char *path,
                                const render_write_options *options, const report_watch *watch,
                                hnbrdf_error *error)
{
    hnbrdf_result result = report_picture_write(image, path, options, error);
    if (result)
        return result;
    report_tell(watch, path);
    char *beside = hnbrdf_ends_with(path, ".png") ? NULL : report_png_beside(path);
    if (beside)
        report_tell(watch, beside);
    free(beside);
    return HNBRDF_OK;
}

const char *report_base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}
