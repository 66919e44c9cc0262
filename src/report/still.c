/* still.c: the picture of one material, on a sphere or a mesh, before a background. */
#include "report/still.h"

#include "base/clock.h"
#include "base/error.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const hnbrdf_material *material_of(const report_still *s)
{
    return s->model ? hnbrdf_model_material(s->model, s->material) : NULL;
}

/* With directions from a guide. */
static render_surface make_surface(const report_still *s, int analytic)
{
    render_surface surface = !s->model  ? render_surface_measured(s->measured)
                             : analytic ? render_surface_analytic(s->model, material_of(s))
                                        : render_surface_model(s->model, material_of(s));
    const render_surface *one = &surface;
    render_guide guide = render_guide_fit(&one, 1, s->spheres.guide);
    render_surface_guide(&surface, &guide);
    return surface;
}

static hnbrdf_result render_one(report_still *s, int analytic, render_image *image,
                                hnbrdf_error *error)
{
    render_surface surface = make_surface(s, analytic);
    hnbrdf_result result = report_spheres_render(&s->spheres, &surface, image, error);
    s->spheres.first++;
    return result;
}

static hnbrdf_result render_sphere_of(report_still *s, hnbrdf_error *error)
{
    render_image analytic = {0};
    s->spheres.count = 1 + s->layers;
    hnbrdf_result result = render_one(s, s->analytic, &s->image, error);
    if (result || !s->layers)
        return result;
    result = render_one(s, 1, &analytic, error);
    if (!result)
        result = render_image_add_layer(&s->image, "analytic", analytic.rgb, error);
    if (!result)
        analytic.rgb = NULL;
    render_image_free(&analytic);
    return result;
}

static int show(void *still, double share)
{
    const report_watch *watch = &((const report_still *)still)->spheres.watch;
    report_show(watch, share, NULL);
    return report_stop(watch);
}

static hnbrdf_result render_mesh_of(report_still *s, render_outcome *outcome, hnbrdf_error *error)
{
    /* A model draws its own directions; what else there is has a guide. */
    render_surface surface = s->model && !s->analytic
                                 ? render_surface_model(s->model, material_of(s))
                                 : make_surface(s, s->analytic);
    render_job job = s->job;
    job.spp = s->spheres.light.spp;
    job.seed = s->spheres.light.seed;
    job.threads = s->spheres.light.threads;
    job.transparent = s->background != REPORT_ENVIRONMENT;
    job.progress = show;
    job.progress_user = s;
    return render_mesh_view_run(&s->mesh, &surface, &s->spheres.environment, (int)s->spheres.size,
                                &job, &s->image, outcome, error);
}

hnbrdf_result report_still_render(report_still *s, render_outcome *outcome, hnbrdf_error *error)
{
    *outcome = (render_outcome){.complete = 1};
    return s->mesh.path ? render_mesh_of(s, outcome, error) : render_sphere_of(s, error);
}

render_options report_still_options(const report_still *s)
{
    return (render_options){.size = (int)s->spheres.size,
                            .spp = (int)s->spheres.light.spp,
                            .seed = (uint64_t)s->spheres.light.seed,
                            .threads = (int)s->spheres.light.threads};
}

hnbrdf_result report_still_check(report_still *s, report_same_picture *same, double *seconds,
                                 hnbrdf_error *error)
{
    render_surface surface = render_surface_model(s->model, material_of(s));
    render_image cpu;
    double started = hnbrdf_seconds();
    s->spheres.count = 1;
    hnbrdf_result result = report_spheres_render(&s->spheres, &surface, &cpu, error);
    *seconds = hnbrdf_seconds() - started;
    if (result)
        return result;
    result = report_same_picture_measure(&s->image, &cpu, same, error);
    render_image_free(&cpu);
    return result;
}

hnbrdf_result report_still_write(report_still *s, const char *path, hnbrdf_error *error)
{
    char comments[512];
    const report_light *light = &s->spheres.light;
    const char *name = s->model ? hnbrdf_model_material_name(s->model, s->material)
                                : hnbrdf_measured_name(s->measured);
    if (s->background == REPORT_BACKDROP)
        render_over_backdrop(&s->image, 0.16 * exp2(-light->exposure));
    else if (s->background == REPORT_ENVIRONMENT && !s->mesh.path)
        render_over_environment(&s->image, &s->spheres.environment,
                                strcmp(light->env, "furnace") == 0 ? 1.0 : 0.35);
    snprintf(comments, sizeof comments, "hnbrdf %s render: %s%s, %ld samples a pixel, seed %ld",
             hnbrdf_version(), name, s->analytic ? " (analytic part)" : "", light->spp,
             light->seed);
    const render_write_options options = {
        .exposure = light->exposure, .half = s->half, .comments = comments};
    return report_write_told(&s->image, path, &options, &s->spheres.watch, error);
}
