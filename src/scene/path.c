/* path.c: path tracing, some hundred paths side by side: those that hit the same surface are
 * evaluated in one batch. Light and BRDF sampling are joined by the balance heuristic (Veach and
 * Guibas 1995), paths end by Russian roulette (Arvo and Kirk 1990). */
#include "scene/film.h"

#include <math.h>
#include <string.h>

enum { PIXELS = RENDER_TILE * RENDER_TILE, WAVE = 2 * PIXELS, SURE_BOUNCES = 3 };

/* Dimensions of random numbers: two for the camera, then six a bounce. */
enum { PAIR_PIXEL, PAIR_LENS, PAIRS_BEFORE };
enum { PAIR_LIGHT, PAIR_CHOICE = PAIR_LIGHT + RENDER_WAYS, PAIR_DIRECTION, PAIR_LOBE, PAIRS };

typedef struct path {
    float origin[3], direction[3];
    double throughput[3], radiance[3];
    double density; /* with which the BRDF drew the direction; 0: it is the camera's */
    uint64_t key;
    uint32_t sample;
    int pixel; /* of the film */
    float albedo[3], normal[3];
    int seen;
    render_surface_point point;
} path;

/* A direction that waits for its evaluation: factor is all but f. */
typedef struct candidate {
    float wi[3], direction[3], distance;
    double factor[3];
    int used;
} candidate;

typedef struct wave {
    const render_scene *scene;
    const render_path_options *options;
    path paths[WAVE];
    candidate lights[WAVE][RENDER_WAYS];
    int active[WAVE], order[WAVE];
    int active_count, bounce;
} wave;

static void random_pair(const path *p, uint32_t dimension, double u[2])
{
    uint32_t bits[2];
    render_endless_pair(p->key, dimension, p->sample, bits);
    u[0] = bits[0] * 0x1p-32;
    u[1] = bits[1] * 0x1p-32;
}

static uint32_t dimension(const wave *w, int pair)
{
    return (uint32_t)(PAIRS_BEFORE + PAIRS * w->bounce + pair);
}

static float unit_float(double u)
{
    return (float)((uint32_t)(u * 0x1p24)) * 0x1p-24f;
}

/* ---- Camera ---------------------------------------------------------------------------------- */

static void start_path(const wave *w, int width, int column, int row, path *p)
{
    const render_camera *camera = &w->scene->camera;
    double u[2], lens[2], length = 0.0;
    random_pair(p, PAIR_PIXEL, u);
    double x = (column + u[0] - 0.5 * camera->width) / camera->height * (double)camera->plane;
    double y = (0.5 * camera->height - row - u[1]) / camera->height * (double)camera->plane;
    double offset[2] = {0.0, 0.0}, d[3];
    if (camera->lens > 0.0f) {
        random_pair(p, PAIR_LENS, lens);
        double radius = (double)camera->lens * sqrt(lens[0]),
               angle = 2.0 * 3.14159265358979323846 * lens[1];
        offset[0] = radius * cos(angle);
        offset[1] = radius * sin(angle);
        x -= offset[0] / (double)camera->focus;
        y -= offset[1] / (double)camera->focus;
    }
    for (int k = 0; k < 3; k++) {
        d[k] = x * (double)camera->axes[0][k] + y * (double)camera->axes[1][k] -
               (double)camera->axes[2][k];
        length += d[k] * d[k];
    }
    for (int k = 0; k < 3; k++) {
        p->direction[k] = (float)(d[k] / sqrt(length));
        p->origin[k] = camera->from[k] + (float)offset[0] * camera->axes[0][k] +
                       (float)offset[1] * camera->axes[1][k];
        p->throughput[k] = 1.0;
    }
    p->pixel = row * width + column;
}

/* ---- What a path brings ---------------------------------------------------------------------- */

static double largest(const double v[3])
{
    return fmax(v[0], fmax(v[1], v[2]));
}

/* `direct`: of the first surface, or seen by the camera itself. */
static void add_light(const wave *w, path *p, const double light[3], int direct)
{
    double limit = w->options->clamp, most = largest(light);
    double scale = limit > 0.0 && !direct && most > limit ? limit / most : 1.0;
    for (int k = 0; k < 3; k++)
        p->radiance[k] += scale * light[k];
}

/* Light that the path's own ray came upon; light_density: with which light sampling had drawn it.
 * */
static void add_found(const wave *w, path *p, const float radiance[3], double light_density)
{
    double weight = 1.0, light[3];
    if (p->density > 0.0 && w->options->strategy == RENDER_MIS)
        weight = p->density / (p->density + light_density);
    else if (p->density > 0.0 && w->options->strategy == RENDER_LIGHT)
        weight = 0.0;
    for (int k = 0; k < 3; k++)
        light[k] = p->throughput[k] * (double)radiance[k] * weight;
    add_light(w, p, light, w->bounce <= 1);
}

static void note_first(const wave *w, path *p)
{
    p->seen = 1;
    memcpy(p->normal, p->point.frame.normal, sizeof p->normal);
    if (p->point.surface < 0)
        return;
    const float(*table)[3] = (const float(*)[3])w->scene->surfaces[p->point.surface].albedo;
    float x = p->point.frame.wo[2] * RENDER_ALBEDO_STEPS - 0.5f;
    x = x > 0.0f ? (x < RENDER_ALBEDO_STEPS - 1 ? x : RENDER_ALBEDO_STEPS - 1) : 0.0f;
    int i = x < RENDER_ALBEDO_STEPS - 2 ? (int)x : RENDER_ALBEDO_STEPS - 2;
    for (int k = 0; k < 3; k++)
        p->albedo[k] = table[i][k] + (x - (float)i) * (table[i + 1][k] - table[i][k]);
}

/* Follows the ray of a path to its end; returns 1 if it is to be reflected there. */
static int trace_path(const wave *w, path *p)
{
    const render_scene *scene = w->scene;
    render_hit hit;
    render_trace_closest(scene->trace, p->origin, p->direction, &hit);
    if (hit.shape == RENDER_NONE) {
        float radiance[3];
        double density = render_light_behind(scene, p->origin, p->direction, radiance);
        if (w->bounce > 0 || !w->options->transparent)
            add_found(w, p, radiance, density);
        return 0;
    }
    render_surface_at(scene, p->origin, p->direction, &hit, &p->point);
    if (w->bounce == 0)
        note_first(w, p);
    const float *emission = scene->shapes[hit.shape].emission;
    if (p->point.outside && scene->light_count && emission[0] + emission[1] + emission[2] > 0.0f) {
        float cosine = -render_dot(p->point.geometric, p->direction);
        if (cosine > 0.0f)
            add_found(w, p, emission,
                      render_light_density(scene, hit.shape, hit.primitive, hit.distance, cosine));
    }
    return p->point.surface >= 0 && w->bounce < w->options->bounces;
}

/* ---- Reflection ------------------------------------------------------------------------------ */

static void to_local(const render_point *frame, const float world[3], float local[3])
{
    local[0] = render_dot(world, frame->tangent);
    local[1] = render_dot(world, frame->bitangent);
    local[2] = render_dot(world, frame->normal);
}

/* Above the shading horizon and that of the surface itself. */
static int is_above(const path *p, const float wi[3], const float direction[3])
{
    return wi[2] > 0.0f && render_dot(direction, p->point.geometric) > 0.0f;
}

static void draw_light(const wave *w, const path *p, const render_surface *surface, int way,
                       candidate *c)
{
    double u[2], choice[2];
    render_light_sample light;
    c->used = 0;
    random_pair(p, dimension(w, PAIR_LIGHT + way), u);
    random_pair(p, dimension(w, PAIR_CHOICE), choice);
    render_light_draw(w->scene, way, p->point.position, choice[0], u, &light);
    if (!(light.density > 0.0))
        return;
    to_local(&p->point.frame, light.direction, c->wi);
    if (!is_above(p, c->wi, light.direction))
        return;
    double density = light.density;
    if (w->options->strategy == RENDER_MIS)
        density += (double)surface->pdf(surface, c->wi, p->point.frame.wo);
    for (int k = 0; k < 3; k++)
        c->factor[k] = p->throughput[k] * (double)light.radiance[k] * (double)c->wi[2] / density;
    memcpy(c->direction, light.direction, sizeof c->direction);
    c->distance = light.distance;
    c->used = largest(c->factor) > 0.0;
}

/* The next direction; returns its density, 0 for none. */
static float draw_direction(const wave *w, path *p, const render_surface *surface, float wi[3])
{
    double u[2], lobe[2];
    random_pair(p, dimension(w, PAIR_DIRECTION), u);
    random_pair(p, dimension(w, PAIR_LOBE), lobe);
    const float numbers[3] = {unit_float(lobe[0]), unit_float(u[0]), unit_float(u[1])};
    const render_point *frame = &p->point.frame;
    float density = surface->sample(surface, frame->wo, numbers, wi);
    if (!(density > 0.0f))
        return 0.0f;
    for (int k = 0; k < 3; k++)
        p->direction[k] =
            wi[0] * frame->tangent[k] + wi[1] * frame->bitangent[k] + wi[2] * frame->normal[k];
    return is_above(p, wi, p->direction) ? density : 0.0f;
}

/* Returns 1 if the path goes on. */
static int go_on(const wave *w, path *p, float density, const float wi[3], const float f[3])
{
    double choice[2];
    for (int k = 0; k < 3; k++)
        p->throughput[k] *= (double)f[k] * (double)wi[2] / (double)density;
    double most = largest(p->throughput);
    if (!(most > 0.0))
        return 0;
    if (w->bounce >= SURE_BOUNCES) {
        random_pair(p, dimension(w, PAIR_CHOICE), choice);
        double survival = fmin(0.95, most);
        if (choice[1] >= survival)
            return 0;
        for (int k = 0; k < 3; k++)
            p->throughput[k] /= survival;
    }
    p->density = (double)density;
    render_ray_start(&p->point, p->origin);
    return 1;
}

/* Pairs of directions of one surface that wait for one call. */
typedef struct batch {
    float wi[(RENDER_WAYS + 1) * WAVE][3], wo[(RENDER_WAYS + 1) * WAVE][3],
        f[(RENDER_WAYS + 1) * WAVE][3];
    size_t count;
} batch;

static void add_pair(batch *b, const float wi[3], const float wo[3])
{
    memcpy(b->wi[b->count], wi, sizeof *b->wi);
    memcpy(b->wo[b->count++], wo, sizeof *b->wo);
}

static void shine(const wave *w, path *p, candidate *light, const float f[3])
{
    float origin[3];
    for (int k = 0; k < 3; k++)
        light->factor[k] *= (double)f[k];
    if (!(largest(light->factor) > 0.0))
        return;
    render_ray_start(&p->point, origin);
    if (!render_trace_blocked(w->scene->trace, origin, light->direction, light->distance))
        add_light(w, p, light->factor, w->bounce == 0);
}

/* One surface's share of the wave: `count` paths by number; those that go on are left in
 * `numbers`, in their order. Returns how many. */
static int reflect(wave *w, const render_surface *surface, int *numbers, int count)
{
    batch b;
    float wi[WAVE][3], density[WAVE];
    b.count = 0;
    for (int i = 0; i < count; i++) {
        path *p = &w->paths[numbers[i]];
        candidate *lights = w->lights[numbers[i]];
        for (int way = 0; way < RENDER_WAYS; way++) {
            lights[way].used = 0;
            if (w->options->strategy != RENDER_BRDF)
                draw_light(w, p, surface, way, &lights[way]);
            if (lights[way].used)
                add_pair(&b, lights[way].wi, p->point.frame.wo);
        }
        density[i] = draw_direction(w, p, surface, wi[i]);
        if (density[i] > 0.0f)
            add_pair(&b, wi[i], p->point.frame.wo);
    }
    if (b.count)
        surface->eval(surface, b.count, b.wi[0], b.wo[0], b.f[0]);
    int left = 0;
    size_t next = 0;
    for (int i = 0; i < count; i++) {
        path *p = &w->paths[numbers[i]];
        candidate *lights = w->lights[numbers[i]];
        for (int way = 0; way < RENDER_WAYS; way++)
            if (lights[way].used)
                shine(w, p, &lights[way], b.f[next++]);
        if (density[i] > 0.0f && go_on(w, p, density[i], wi[i], b.f[next++]))
            numbers[left++] = numbers[i];
    }
    return left;
}

/* Paths in the order of their surfaces; those of one surface in their own. */
static void sort_by_surface(wave *w)
{
    int next[RENDER_MAX_SURFACES + 1] = {0};
    for (int i = 0; i < w->active_count; i++)
        next[w->paths[w->active[i]].point.surface + 1]++;
    for (int s = 0; s < w->scene->surface_count; s++)
        next[s + 1] += next[s];
    for (int i = 0; i < w->active_count; i++)
        w->order[next[w->paths[w->active[i]].point.surface]++] = w->active[i];
}

static void bounce(wave *w)
{
    int left = 0;
    for (int i = 0; i < w->active_count; i++)
        if (trace_path(w, &w->paths[w->active[i]]))
            w->active[left++] = w->active[i];
    w->active_count = left;
    sort_by_surface(w);
    w->active_count = 0;
    int count = left;
    for (int first = 0, end; first < count; first = end) {
        int surface = w->paths[w->order[first]].point.surface;
        for (end = first; end < count && w->paths[w->order[end]].point.surface == surface;)
            end++;
        int still = reflect(w, &w->scene->surfaces[surface].surface, w->order + first, end - first);
        memcpy(w->active + w->active_count, w->order + first, (size_t)still * sizeof *w->active);
        w->active_count += still;
    }
    w->bounce++;
}

/* ---- Tiles ----------------------------------------------------------------------------------- */

static void add_to_film(const path *p, render_film *film)
{
    double *sums = film->sums[p->pixel];
    sums[RENDER_COVERAGE] += p->seen;
    for (int k = 0; k < 3; k++) {
        sums[RENDER_RADIANCE + k] += p->radiance[k];
        sums[RENDER_ALBEDO + k] += (double)p->albedo[k];
        sums[RENDER_NORMAL + k] += (double)p->normal[k];
    }
}

void render_path_tile(const render_scene *scene, const render_path_options *options,
                      render_film *film, int tile, int first, int count)
{
    wave w;
    w.scene = scene;
    w.options = options;
    int x0 = tile % film->tiles_across * RENDER_TILE, y0 = tile / film->tiles_across * RENDER_TILE;
    for (int sample = first; sample < first + count;) {
        int paths = 0;
        for (; sample < first + count && paths + PIXELS <= WAVE; sample++)
            for (int y = y0; y < y0 + RENDER_TILE && y < film->height; y++)
                for (int x = x0; x < x0 + RENDER_TILE && x < film->width; x++) {
                    path *p = &w.paths[paths];
                    memset(p, 0, sizeof *p);
                    p->key = render_pixel_key(options->seed,
                                              (uint64_t)y * (uint64_t)film->width + (uint64_t)x);
                    p->sample = (uint32_t)sample;
                    start_path(&w, film->width, x, y, p);
                    w.active[paths] = paths;
                    paths++;
                }
        w.active_count = paths;
        for (w.bounce = 0; w.active_count > 0;)
            bounce(&w);
        for (int i = 0; i < paths; i++)
            add_to_film(&w.paths[i], film);
    }
}
