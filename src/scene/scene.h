/* scene.h: surfaces on shapes, under lights, before a camera, ready to be traced. Needs Embree. */
#ifndef HNBRDF_SCENE_SCENE_H
#define HNBRDF_SCENE_SCENE_H

#include "scene/mesh.h"
#include "render/render.h"

/* ---- What is there --------------------------------------------------------------------------- */

/* One shape in the world: a mesh, or a sphere where the mesh is empty. Both sides of a surface
 * reflect; light is given off by the outside alone. */
typedef struct render_shape {
    render_mesh mesh;
    int *surfaces; /* of each part of the mesh, or of the sphere: a number, -1 reflects nothing */
    float centre[3], radius, axes[3][3]; /* of a sphere; its frame turns about axes[1] */
    float emission[3];                   /* radiance */
    uint32_t first_light;                /* of the scene; set by render_scene_build() */
} render_shape;

/* What an environment is seen through: a parallelogram corner + s edge[0] + t edge[1]. Light
 * sampling looks through it too; what is lit changes only in noise. */
typedef struct render_portal {
    float corner[3], edge[2][3];
    float normal[3], area; /* set by render_scene_build() */
} render_portal;

typedef struct render_camera {
    float from[3], to[3], up[3];
    float fov; /* degrees, vertical */
    /* radius of a thin lens, 0: pinhole; distance that is sharp, 0: that of `to` */
    float lens, focus;
    int width, height;
    float axes[3][3],
        plane; /* right, up, back; height of the picture at distance 1; set by the build */
} render_camera;

enum {
    RENDER_ALBEDO_STEPS = 16,
    RENDER_MAX_SHAPES = 4096,
    RENDER_MAX_SURFACES = 1024,
    RENDER_MAX_PORTALS = 64
};

/* Largest coordinate: fourth powers of edges, of which lengths of normals are made, fit a float. */
#define RENDER_FAR 1e9

/* A surface of the scene, with its directional albedo at cosines (k + 0.5) / RENDER_ALBEDO_STEPS.
 * */
typedef struct render_scene_surface {
    render_surface surface;
    float albedo[RENDER_ALBEDO_STEPS][3]; /* set by the build */
} render_scene_surface;

/* One thing that gives off light: a triangle, or a sphere. */
typedef struct render_light {
    uint32_t shape, primitive;
    float area;
} render_light;

struct render_trace; /* Embree's part */

/* Fill in surfaces, shapes, portals, camera and environment, then build. */
typedef struct render_scene {
    render_scene_surface *surfaces;
    int surface_count;
    render_shape *shapes;
    int shape_count;
    render_portal portals[RENDER_MAX_PORTALS];
    int portal_count;
    const render_environment *environment; /* borrowed; NULL: black */
    render_camera camera;

    /* Made by render_scene_build(). */
    render_light *lights;
    render_environment guide; /* the environment as far as portals show it; rgb NULL: no portals */
    double *light_sums;       /* inclusive sums of power, area times luminance */
    uint32_t light_count;
    struct render_trace *trace;
} render_scene;

/* 0 when the program was built without Embree: building a scene then fails with a message saying
 * so. */
int render_has_embree(void);
/* Index structures, lights, camera, albedos. The scene must not move or change afterwards. */
hnbrdf_result render_scene_build(render_scene *scene, hnbrdf_error *error);
/* Frees the arrays and what was built; not what surfaces and environment borrow. */
void render_scene_free(render_scene *scene);
/* A number that depends on all that the picture depends on, but for seed and options. */
uint64_t render_scene_fingerprint(const render_scene *scene);

/* ---- Rays ------------------------------------------------------------------------------------ */

/* Where a ray ends. */
typedef struct render_hit {
    uint32_t shape, primitive; /* shape RENDER_NONE: nowhere */
    float distance, u, v;      /* barycentric, of corners 1 and 2 */
} render_hit;

hnbrdf_result render_trace_create(const render_scene *scene, struct render_trace **trace,
                                  hnbrdf_error *error);
void render_trace_free(struct render_trace *trace);
void render_trace_closest(const struct render_trace *trace, const float origin[3],
                          const float direction[3], render_hit *hit);
/* 1 if something lies nearer than distance. */
int render_trace_blocked(const struct render_trace *trace, const float origin[3],
                         const float direction[3], float distance);

/* A point on a surface, seen from `wo` (world, unit): the side that is seen. */
typedef struct render_surface_point {
    render_point frame; /* shading frame, and wo in it: wo.z > 0 */
    float position[3];
    float geometric[3];   /* normal of the triangle, towards the viewer */
    int surface, outside; /* number of the surface or -1; whether it is the outside that is seen */
} render_surface_point;
/*
 * Interpolated normals that would have the viewer, or the mirror direction, below the surface are
 * bent just so far that both are above it: no black edges. A direction below the plane of the
 * triangle gets no light whatever the shading normal says: nothing leaks through a surface. */
void render_surface_at(const render_scene *scene, const float origin[3], const float direction[3],
                       const render_hit *hit, render_surface_point *point);
/* How far off a surface rays start: a few roundings of its positions, which are off by a few 2^-24
 * of the largest coordinate. */
static inline float render_ray_step(float largest)
{
    return 0x1p-18f * (largest > 0x1p-6f ? largest : 0x1p-6f);
}
/* The start of a ray that leaves the point, on the seen side. */
void render_ray_start(const render_surface_point *point, float origin[3]);

/* ---- Lights ---------------------------------------------------------------------------------- */

typedef struct render_light_sample {
    float direction[3], distance; /* INFINITY for the environment */
    float radiance[3];
    double density; /* 1/sr, of the whole mixture of lights; 0: no light that way */
} render_light_sample;

/* Three ways to look for light; each gives one sample, and its density is the sum of all three. */
enum { RENDER_BY_MAP, RENDER_BY_PORTALS, RENDER_BY_SHAPES, RENDER_WAYS };
/* Density 0 where the scene has no such light. `choice` is for one of many shapes. */
void render_light_draw(const render_scene *scene, int way, const float position[3], double choice,
                       const double u[2], render_light_sample *sample);
/* Radiance of the environment, 0 without; returns the density with which the above would
 * draw it. */
double render_light_behind(const render_scene *scene, const float position[3],
                           const float direction[3], float radiance[3]);
/* The density with which it would draw a point on a light's outside: the light of a shape's
 * primitive, at a distance, its normal at cosine to the ray. */
double render_light_density(const render_scene *scene, uint32_t shape, uint32_t primitive,
                            float distance, float cosine);

/* The environment that samples are drawn from. */
static inline const render_environment *render_light_guide(const render_scene *scene)
{
    return scene->guide.rgb ? &scene->guide : scene->environment;
}
/* Density of directions through one portal from a position: uniform over its area. 0 beside it. */
double render_portal_density(const render_portal *portal, const float position[3],
                             const float direction[3]);
/* Makes the guide of a scene with portals. */
hnbrdf_result render_portal_guide(const render_scene *scene, render_environment *guide,
                                  hnbrdf_error *error);

/* ---- Small vectors --------------------------------------------------------------------------- */

static inline float render_dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void render_cross(const float a[3], const float b[3], float c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

#endif
