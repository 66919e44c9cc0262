/* report_images.c: the PSNR of a sphere of every material, beside the errors over directions: SMAPE
 * looks at dark directions, PSNR at highlights. */
#include "cli/picture.h"
#include "cli/report.h"
#include "hnbrdf/metrics.h"

#include <stdlib.h>
#include <string.h>

struct report_images {
    render_environment environment;
    hnbrdf_model *guide_model;
    render_guide *guides; /* [materials]: they suit the measurement and GGX, and serve every model, so
                             that all pictures of a material share their random directions */
    render_image *references; /* [materials] */
};

static int render(const report *r, int m, render_surface *surface, render_image *image)
{
    hnbrdf_error error;
    const render_options options = {
        .size = (int)r->image_size, .spp = REPORT_IMAGE_SAMPLES, .seed = 1, .threads = (int)r->threads};
    render_surface_guide(surface, &r->images->guides[m]);
    if (render_sphere(surface, &r->images->environment, &options, image, &error) == HNBRDF_OK)
        return CLI_OK;
    return cli_fail("%s: %s", hnbrdf_measured_name(r->data.items[m]), error.text);
}

static int make_reference(report *r, int m, const hnbrdf_model *ggx)
{
    render_surface measured = render_surface_measured(r->data.items[m]);
    render_surface analytic = render_surface_analytic(ggx, hnbrdf_model_material(ggx, m));
    const render_surface *both[] = {&measured, &analytic};
    r->images->guides[m] = render_guide_fit(both, 2, r->images->guide_model);
    return render(r, m, &measured, &r->images->references[m]);
}

int report_images_begin(report *r, const hnbrdf_model *ggx)
{
    picture_options light = PICTURE_DEFAULTS(REPORT_IMAGE_SAMPLES);
    hnbrdf_error error;
    size_t count = (size_t)r->data.count;
    report_images *images = r->images = calloc(1, sizeof *images);
    if (images) {
        images->guides = calloc(count, sizeof *images->guides);
        images->references = calloc(count, sizeof *images->references);
    }
    if (!images || !images->guides || !images->references)
        return cli_fail("out of memory");
    int code = picture_open_light(&light, &images->environment);
    if (code == CLI_OK && render_guide_model(&images->guide_model, &error) != HNBRDF_OK)
        code = cli_fail("%s", error.text);
    for (int m = 0; m < r->data.count && code == CLI_OK; m++)
        code = make_reference(r, m, ggx);
    return code;
}

int report_images_measure(report *r, report_entry *e, const hnbrdf_model *model)
{
    int code = CLI_OK;
    e->mean_psnr = 0.0;
    for (int m = 0; m < r->data.count && code == CLI_OK; m++) {
        render_image image = {0};
        hnbrdf_image_error error = {0};
        render_surface surface = render_surface_model(model, hnbrdf_model_material(model, m));
        code = render(r, m, &surface, &image);
        if (code == CLI_OK)
            code = picture_compare(&image, &r->images->references[m], &error);
        render_image_free(&image);
        e->psnr[m] = error.psnr < REPORT_PSNR_LIMIT ? error.psnr : REPORT_PSNR_LIMIT;
        e->mean_psnr += e->psnr[m] / r->data.count;
    }
    return code;
}

void report_images_end(report *r)
{
    report_images *images = r->images;
    if (!images)
        return;
    for (int m = 0; images->references && m < r->data.count; m++)
        render_image_free(&images->references[m]);
    free(images->references);
    free(images->guides);
    hnbrdf_model_free(images->guide_model);
    render_environment_free(&images->environment);
    free(images);
    r->images = NULL;
}
