// exr_planes_cxx.cc: the values of an OpenEXR picture by the C++ library, which decodes DWAA and
// DWAB before version 3.2 of the C library does. No exception leaves this file.
#include "image/exr.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>

namespace
{

class memory_stream : public OPENEXR_IMF_NAMESPACE::IStream
{
  public:
    memory_stream(const void *data, std::size_t size)
        : IStream("memory"), bytes(static_cast<const char *>(data)), count(size)
    {
    }
    bool read(char *to, int size) override
    {
        if (size < 0 || place > count || static_cast<std::size_t>(size) > count - place)
            throw std::runtime_error("the file ends too early");
        std::memcpy(to, bytes + place, static_cast<std::size_t>(size));
        place += static_cast<std::size_t>(size);
        return place < count;
    }
    std::uint64_t tellg() override
    {
        return place;
    }
    void seekg(std::uint64_t to) override
    {
        place = to;
    }

  private:
    const char *bytes;
    std::size_t count, place = 0;
};

// The library reads an attribute of a known type by that, whatever size it claims.
bool has_its_size(const char *type, const char *value, std::size_t size)
{
    static const struct {
        const char *type;
        std::size_t size;
    } fixed[] = {{"box2i", 16},   {"box2f", 16},   {"compression", 1},    {"lineOrder", 1},
                 {"envmap", 1},   {"int", 4},      {"float", 4},          {"double", 8},
                 {"v2i", 8},      {"v2f", 8},      {"v3i", 12},           {"v3f", 12},
                 {"v2d", 16},     {"v3d", 24},     {"m33f", 36},          {"m44f", 64},
                 {"m33d", 72},    {"m44d", 128},   {"rational", 8},       {"timecode", 8},
                 {"keycode", 28}, {"tiledesc", 9}, {"chromaticities", 32}};
    for (const auto &known : fixed)
        if (std::strcmp(type, known.type) == 0)
            return size == known.size;
    if (std::strcmp(type, "chlist") != 0)
        return true;
    std::size_t at = 0; // names and 16 bytes each, then an empty name
    while (at < size && value[at])
        at += strnlen(value + at, size - at) + 1 + 16;
    return at + 1 == size;
}

// The library allocates what an attribute of a type that it does not know claims to need, before it
// reads any of it: no attribute may be longer than what is left of the file.
void check_attributes(const char *at, const char *end, bool many_parts)
{
    int empty = 0; // names in a row: one ends a header, two end those of many parts
    for (at += 8; empty < (many_parts ? 2 : 1);) {
        const char *parts[2];
        for (const char *&part : parts) {
            part = at;
            at = at < end ? static_cast<const char *>(
                                std::memchr(at, 0, static_cast<std::size_t>(end - at)))
                          : nullptr;
            if (!at)
                throw std::runtime_error("the file ends within its header");
            ++at;
            if (&part == parts && !*part)
                break;
        }
        empty = *parts[0] ? 0 : empty + 1;
        if (empty)
            continue;
        std::uint32_t size = 0;
        for (int i = 0; i < 4 && at + i < end; i++)
            size |= static_cast<std::uint32_t>(static_cast<unsigned char>(at[i])) << 8 * i;
        if (end - at < 4 || size > static_cast<std::uint64_t>(end - at - 4))
            throw std::runtime_error("an attribute of the header is longer than the file");
        at += 4;
        if (!has_its_size(parts[1], at, size))
            throw std::runtime_error("an attribute of the header has another size than its type");
        at += size;
    }
}

void read_planes(const void *data, std::size_t size, const exr_picture &picture)
{
    namespace imf = OPENEXR_IMF_NAMESPACE;
    const char *bytes = static_cast<const char *>(data);
    if (size < 9)
        throw std::runtime_error("the file ends within its header");
    check_attributes(bytes, bytes + size, (bytes[5] & 0x10) != 0);
    memory_stream stream(data, size);
    imf::MultiPartInputFile file(stream, 0, false);
    imf::InputPart part(file, picture.part);
    const auto window = part.header().dataWindow();
    if (window.max.x - window.min.x + 1 != picture.width ||
        window.max.y - window.min.y + 1 != picture.height)
        throw std::runtime_error("the C library read another data window");
    imf::FrameBuffer buffer;
    for (const exr_plane &plane : picture.planes)
        if (plane.channel)
            buffer.insert(plane.channel,
                          imf::Slice::Make(imf::FLOAT, plane.values, window, sizeof(float),
                                           sizeof(float) * static_cast<std::size_t>(plane.width),
                                           plane.step, plane.step));
    part.setFrameBuffer(buffer);
    part.readPixels(window.min.y, window.max.y);
}

} // namespace

int exr_read_planes_cxx(const void *data, size_t size, const exr_picture *picture, char *message,
                        size_t room)
{
    try {
        read_planes(data, size, *picture);
        return 0;
    } catch (const std::bad_alloc &) {
        return EXR_CXX_MEMORY;
    } catch (const std::exception &e) {
        std::snprintf(message, room, "%s", e.what());
    } catch (...) {
        std::snprintf(message, room, "the C++ library gave up");
    }
    return EXR_CXX_REFUSED;
}
