/* trace.c: rays against shapes, by Embree 3 or 4. */
#include "scene/scene.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#if !defined(HNBRDF_WITH_EMBREE)

int render_has_embree(void)
{
    return 0;
}

hnbrdf_result render_trace_create(const render_scene *scene, struct render_trace **trace,
                                  hnbrdf_error *error)
{
    (void)scene, (void)trace;
    return hnbrdf_fail(
        error, HNBRDF_ERROR_UNSUPPORTED,
        "this program was built without Embree, which meshes and scenes need: install "
        "libembree-dev and build again");
}

void render_trace_free(struct render_trace *trace)
{
    (void)trace;
}

void render_trace_closest(const struct render_trace *trace, const float origin[3],
                          const float direction[3], render_hit *hit)
{
    (void)trace, (void)origin, (void)direction;
    hit->shape = RENDER_NONE;
}

int render_trace_blocked(const struct render_trace *trace, const float origin[3],
                         const float direction[3], float distance)
{
    (void)trace, (void)origin, (void)direction, (void)distance;
    return 0;
}

#else

#if HNBRDF_WITH_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

struct render_trace {
    RTCDevice device;
    RTCScene scene;
};

int render_has_embree(void)
{
    return 1;
}

static int set_buffer(RTCGeometry geometry, enum RTCBufferType type, enum RTCFormat format,
                      const void *data, size_t stride, size_t count, int padded)
{
    /* Embree reads 16 bytes at a time: a buffer of its own where ours ends too soon. */
    size_t element = padded ? 3 * sizeof(float) : stride;
    char *buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, element, count);
    for (size_t i = 0; buffer && i < count; i++)
        memcpy(buffer + i * element, (const char *)data + i * stride, element);
    return buffer != NULL;
}

static int add_shape(const struct render_trace *trace, const render_shape *shape, unsigned id)
{
    int is_sphere = shape->mesh.triangle_count == 0;
    const float sphere[4] = {shape->centre[0], shape->centre[1], shape->centre[2], shape->radius};
    RTCGeometry geometry = rtcNewGeometry(trace->device, is_sphere ? RTC_GEOMETRY_TYPE_SPHERE_POINT
                                                                   : RTC_GEOMETRY_TYPE_TRIANGLE);
    int done = geometry != NULL;
    if (done && is_sphere)
        done = set_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, sphere,
                          sizeof sphere, 1, 0);
    else if (done)
        done =
            set_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, shape->mesh.positions,
                       sizeof *shape->mesh.positions, shape->mesh.position_count, 1) &&
            set_buffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, shape->mesh.triangles,
                       sizeof *shape->mesh.triangles, shape->mesh.triangle_count, 1);
    if (done) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(trace->scene, geometry, id);
    }
    if (geometry)
        rtcReleaseGeometry(geometry);
    return done;
}

hnbrdf_result render_trace_create(const render_scene *scene, struct render_trace **trace,
                                  hnbrdf_error *error)
{
    struct render_trace *made = calloc(1, sizeof *made);
    int done = made != NULL;
    if (done) {
        /* One thread: the same tree, and so the same hits, every time. */
        made->device = rtcNewDevice("threads=1,set_affinity=0");
        made->scene = made->device ? rtcNewScene(made->device) : NULL;
        done = made->scene != NULL;
    }
    if (done) {
        rtcSetSceneFlags(made->scene, RTC_SCENE_FLAG_ROBUST);
        for (int i = 0; i < scene->shape_count && done; i++)
            done = add_shape(made, &scene->shapes[i], (unsigned)i);
    }
    if (done) {
        rtcCommitScene(made->scene);
        enum RTCError code = rtcGetDeviceError(made->device);
        if (code == RTC_ERROR_NONE) {
            *trace = made;
            return HNBRDF_OK;
        }
        render_trace_free(made);
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY,
                           "Embree cannot index the scene (its error %d)", (int)code);
    }
    render_trace_free(made);
    return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory to index the scene");
}

void render_trace_free(struct render_trace *trace)
{
    if (!trace)
        return;
    if (trace->scene)
        rtcReleaseScene(trace->scene);
    if (trace->device)
        rtcReleaseDevice(trace->device);
    free(trace);
}

static struct RTCRay make_ray(const float origin[3], const float direction[3], float distance)
{
    return (struct RTCRay){.org_x = origin[0],
                           .org_y = origin[1],
                           .org_z = origin[2],
                           .dir_x = direction[0],
                           .dir_y = direction[1],
                           .dir_z = direction[2],
                           .tfar = distance,
                           .mask = 0xffffffffu};
}

void render_trace_closest(const struct render_trace *trace, const float origin[3],
                          const float direction[3], render_hit *hit)
{
    struct RTCRayHit ray = {.ray = make_ray(origin, direction, INFINITY)};
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if HNBRDF_WITH_EMBREE >= 4
    rtcIntersect1(trace->scene, &ray, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(trace->scene, &context, &ray);
#endif
    hit->shape = ray.hit.geomID;
    hit->primitive = ray.hit.primID;
    hit->distance = ray.ray.tfar;
    hit->u = ray.hit.u;
    hit->v = ray.hit.v;
}

int render_trace_blocked(const struct render_trace *trace, const float origin[3],
                         const float direction[3], float distance)
{
    struct RTCRay ray = make_ray(origin, direction, distance);
#if HNBRDF_WITH_EMBREE >= 4
    rtcOccluded1(trace->scene, &ray, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(trace->scene, &context, &ray);
#endif
    return ray.tfar < 0.0f;
}

#endif
