// exr_planes_cxx.cc: the values of an OpenEXR picture by the C++ library, which decodes DWAA and
// DWAB before version 3.2 of the C library does. No exception leaves this file.
#include "image/exr.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>

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

void read_planes(const void *data, std::size_t size, const exr_picture &picture)
{
    namespace imf = OPENEXR_IMF_NAMESPACE;
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
