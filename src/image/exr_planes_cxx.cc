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
        at += 4 + size;
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
