// exr_writer.cc: OpenEXR files of every kind, written into memory by OpenEXR's own C++ library.
extern "C" {
#include "image/image.h"
}
#include "exr_writer.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputPart.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

namespace imf = OPENEXR_IMF_NAMESPACE;
using box = IMATH_NAMESPACE::Box2i;
using point = IMATH_NAMESPACE::V2i;

namespace
{

class memory_stream : public imf::OStream
{
  public:
    explicit memory_stream(render_bytes *to) : OStream("memory"), bytes(to)
    {
    }
    void write(const char from[], int size) override
    {
        if (render_bytes_put(bytes, place, from, static_cast<std::size_t>(size)))
            throw std::bad_alloc();
        place += static_cast<std::size_t>(size);
    }
    std::uint64_t tellp() override
    {
        return place;
    }
    void seekp(std::uint64_t to) override
    {
        place = to;
    }

  private:
    render_bytes *bytes;
    std::size_t place = 0;
};

struct channel {
    std::string name;
    imf::PixelType type;
    int step;
};

std::vector<channel> parse(const char *text)
{
    std::istringstream words(text);
    std::vector<channel> channels;
    for (std::string word; words >> word;) {
        const std::size_t colon = word.rfind(':');
        const char type = word[colon + 1];
        std::replace(word.begin(), word.begin() + static_cast<std::ptrdiff_t>(colon), '~', ' ');
        channels.push_back({word.substr(0, colon),
                            type == 'h'   ? imf::HALF
                            : type == 'f' ? imf::FLOAT
                                          : imf::UINT,
                            word.size() > colon + 2 ? word[colon + 2] - '0' : 1});
    }
    return channels;
}

box box_of(const int window[4])
{
    return box(point(window[0], window[1]),
               point(window[0] + window[2] - 1, window[1] + window[3] - 1));
}

bool is_tiled(const exr_part_description &part)
{
    return part.layout == EXR_TILES || part.layout == EXR_MIPMAP || part.layout == EXR_RIPMAP;
}

imf::Header header_of(const exr_part_description &part)
{
    const box data = box_of(part.data);
    imf::Header header(part.display[2] ? box_of(part.display) : data, data);
    header.compression() = static_cast<imf::Compression>(part.compression);
    header.setType(part.layout == EXR_DEEP ? imf::DEEPSCANLINE
                   : is_tiled(part)        ? imf::TILEDIMAGE
                                           : imf::SCANLINEIMAGE);
    if (part.layout == EXR_LINES_DOWN)
        header.lineOrder() = imf::DECREASING_Y;
    if (is_tiled(part))
        header.setTileDescription(
            imf::TileDescription(16, 16,
                                 part.layout == EXR_MIPMAP   ? imf::MIPMAP_LEVELS
                                 : part.layout == EXR_RIPMAP ? imf::RIPMAP_LEVELS
                                                             : imf::ONE_LEVEL));
    for (const channel &c : parse(part.channels))
        header.channels().insert(c.name, imf::Channel(c.type, c.step, c.step, true));
    if (part.name)
        header.setName(part.name);
    if (part.view)
        header.setView(part.view);
    if (part.envmap)
        addEnvmap(header, part.envmap == 2 ? imf::ENVMAP_CUBE : imf::ENVMAP_LATLONG);
    if (part.chromaticities) {
        const float *c = part.chromaticities;
        addChromaticities(
            header, imf::Chromaticities({c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}));
    }
    if (part.neutral)
        addAdoptedNeutral(header, {part.neutral[0], part.neutral[1]});
    if (part.views) {
        std::istringstream words(part.views);
        imf::StringVector names;
        for (std::string word; words >> word;)
            names.push_back(word);
        addMultiView(header, names);
    }
    return header;
}

/* The values of all channels as the file has them. */
struct values {
    std::vector<std::vector<char>> planes;
    imf::FrameBuffer buffer;

    values(const exr_part_description &part, const box &window)
    {
        const std::vector<channel> channels = parse(part.channels);
        planes.resize(channels.size());
        for (std::size_t i = 0; i < channels.size(); i++) {
            const channel &c = channels[i];
            const std::size_t size = c.type == imf::HALF ? 2 : 4;
            const int width = (window.max.x - window.min.x) / c.step + 1;
            const int height = (window.max.y - window.min.y) / c.step + 1;
            planes[i].resize(size * static_cast<std::size_t>(width) *
                             static_cast<std::size_t>(height));
            char *to = planes[i].data();
            for (int y = 0; y < height; y++)
                for (int x = 0; x < width; x++, to += size) {
                    const float v =
                        part.value(part.user, static_cast<int>(i), x * c.step, y * c.step);
                    if (c.type == imf::HALF)
                        *reinterpret_cast<half *>(to) = half(v);
                    else if (c.type == imf::FLOAT)
                        *reinterpret_cast<float *>(to) = v;
                    else
                        *reinterpret_cast<unsigned *>(to) = static_cast<unsigned>(v);
                }
            buffer.insert(c.name,
                          imf::Slice::Make(c.type, planes[i].data(), window, size,
                                           size * static_cast<std::size_t>(width), c.step, c.step));
        }
    }
};

/* Smaller levels are zoomed out of the same values. */
void write_tiles(imf::TiledOutputPart part, const exr_part_description &description)
{
    for (int v = 0; v < part.numYLevels(); v++)
        for (int u = 0; u < part.numXLevels(); u++) {
            if (!part.isValidLevel(u, v))
                continue;
            values of(description, part.dataWindowForLevel(u, v));
            part.setFrameBuffer(of.buffer);
            part.writeTiles(0, part.numXTiles(u) - 1, 0, part.numYTiles(v) - 1, u, v);
        }
}

void write(const exr_part_description *parts, int count, render_bytes *bytes)
{
    memory_stream stream(bytes);
    std::vector<imf::Header> headers;
    for (int i = 0; i < count; i++)
        headers.push_back(header_of(parts[i]));
    imf::MultiPartOutputFile file(stream, headers.data(), count, false, 0);
    for (int i = 0; i < count; i++) {
        if (is_tiled(parts[i])) {
            write_tiles(imf::TiledOutputPart(file, i), parts[i]);
        } else if (parts[i].layout != EXR_DEEP) {
            imf::OutputPart part(file, i);
            values of(parts[i], box_of(parts[i].data));
            part.setFrameBuffer(of.buffer);
            part.writePixels(parts[i].data[3]);
        }
    }
}

} // namespace

const exr_channel_set exr_channel_sets[] = {
    {"R:h G:h B:h", EXR_KIND_RGB, 0},
    {"R:f G:f B:f", EXR_KIND_RGB, 0},
    {"R:h G:h B:h A:h", EXR_KIND_RGBA, 0},
    {"R:h G:f B:h A:f", EXR_KIND_RGBA, 0},           // mixed
    {"R:f G:h B:f Z:u id:u N.X:h", EXR_KIND_RGB, 0}, // what is passed over, between what is read
    {"Y:h", EXR_KIND_GREY, 0},
    {"Y:f A:h", EXR_KIND_GREY_ALPHA, 0},
    {"Y:h RY:h2 BY:h2", EXR_KIND_CHROMA, 1},
    {"Y:f RY:f2 BY:f2", EXR_KIND_CHROMA, 1},
    {"Y:h RY:h BY:h A:h", EXR_KIND_CHROMA_ALPHA, 0},
    {"X:h Y:h Z:h", EXR_KIND_XYZ, 0},
    {"X:f Y:h Z:f", EXR_KIND_XYZ, 0},
    {"diffuse.R:h diffuse.G:h diffuse.B:h", EXR_KIND_RGB, 0},
    {nullptr, EXR_KIND_RGB, 0},
};

const char *exr_compression_name(int compression)
{
    static const char *const names[EXR_COMPRESSIONS] = {"none",  "rle", "zips", "zip",  "piz",
                                                        "pxr24", "b44", "b44a", "dwaa", "dwab"};
    return names[compression];
}

render_bytes exr_write_parts(const exr_part_description *parts, int count)
{
    render_bytes bytes = {nullptr, 0, 0};
    try {
        write(parts, count, &bytes);
    } catch (const std::exception &e) {
        std::fprintf(stderr, "exr_write_parts: %s\n", e.what());
        bytes.size = 0;
    }
    return bytes;
}
