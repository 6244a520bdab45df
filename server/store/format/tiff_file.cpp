// SPDX-License-Identifier: Apache-2.0
#include "store/format/tiff_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <tiffio.h>
#include <unistd.h>

#include "base/load_error.h"
#include "store/format/tiff_handle.h"
#include "store/picture/pyramid.h"

namespace wellspring::store {
namespace {

constexpr int64_t most_block_bytes = int64_t(512) << 20;
constexpr size_t most_idle_handles = 8;
constexpr int most_pages = 256;

// Returns how many bytes a compression packs into one at most; 0: it is not read.
int64_t most_packed_by(int compression) {
  if (!TIFFIsCODECConfigured(uint16_t(compression))) return 0;
  switch (compression) {
    case COMPRESSION_NONE: return 1;
    case COMPRESSION_PACKBITS: return 64;
    case COMPRESSION_DEFLATE:
    case COMPRESSION_ADOBE_DEFLATE: return 1100;
    case COMPRESSION_LZW:
    case COMPRESSION_JPEG: return 1 << 12;
    case COMPRESSION_CCITTRLE:
    case COMPRESSION_CCITTFAX3:
    case COMPRESSION_CCITTFAX4:
    case COMPRESSION_ZSTD:
    case COMPRESSION_WEBP: return 1 << 15;
    default: return 0;
  }
}

// Says whether `page` shows the picture of `full` in fewer texels: sides shrink by one factor, up
// to rounding of either.
bool is_smaller_version(const TiffPage& page, const TiffPage& full) {
  if (!page.is_tiled || page.width > full.width || page.height > full.height ||
      (page.width == full.width && page.height == full.height))
    return false;
  const double across = double(page.width) / double(full.width);
  const double down = double(page.height) / double(full.height);
  return std::abs(double(full.height) * across - double(page.height)) <= 1.01 ||
         std::abs(double(full.width) * down - double(page.width)) <= 1.01;
}

// Turns rows of any number of bits into codes of 8 bits, in place but for fewer than 8 bits, which
// keep their values.
void unpack(std::vector<uint8_t>& bytes, const TiffPage& page, int rows, int channels) {
  const size_t row_codes = size_t(page.block_width) * size_t(channels);
  if (page.bits == 16) {
    for (size_t i = 0; i < row_codes * size_t(rows); i++) {
      uint16_t code;
      std::memcpy(&code, &bytes[2 * i], 2);
      bytes[i] = to_8_bits(code);
    }
    bytes.resize(row_codes * size_t(rows));
  } else if (page.bits < 8) {
    const size_t row_bytes = (row_codes * size_t(page.bits) + 7) / 8;
    std::vector<uint8_t> codes(row_codes * size_t(rows));
    for (size_t y = 0; y < size_t(rows); y++)
      for (size_t x = 0; x < row_codes; x++) {
        const size_t bit = x * size_t(page.bits);
        codes[y * row_codes + x] =
            uint8_t(bytes[y * row_bytes + bit / 8] >> (8 - size_t(page.bits) - bit % 8) &
                    ((1 << page.bits) - 1));
      }
    bytes = std::move(codes);
  }
}

// Divides colours by the alpha that was multiplied into them.
void divide_by_alpha(uint8_t* rgba, size_t count) {
  for (; count > 0; count--, rgba += 4)
    if (const int alpha = rgba[3]; alpha != 0 && alpha != 255)
      for (int c = 0; c < 3; c++)
        rgba[c] = uint8_t(std::min(255, (rgba[c] * 255 + alpha / 2) / alpha));
}

// Says whether a profile changes no colour by more than one code.
bool keeps_colors(const ColorProfile& profile, ColorKind kind) {
  constexpr int step = 17;  // between codes that are tried
  std::vector<uint8_t> colors;
  for (int red = 0; red < 256; red += step)
    for (int green = 0; green < 256; green += step)
      for (int blue = 0; blue < 256; blue += step)
        for (const int code : {red, green, blue, 255})
          colors.push_back(uint8_t(kind == ColorKind::grey ? red : code));
  std::vector<uint8_t> shown = colors;
  profile.convert(colors.data(), shown.data(), colors.size() / 4);
  return std::ranges::equal(colors, shown, [](int a, int b) { return std::abs(a - b) <= 1; });
}

}  // namespace

// Lends a handle to one thread.
struct TiffFile::Lease {
  const TiffFile& file;
  std::unique_ptr<TiffHandle> handle;

  Lease(const TiffFile& file, const TiffPage& page) : file(file) {
    {
      const std::lock_guard lock(file.mutex_);
      const auto found = std::ranges::find_if(
          file.idle_, [&](const auto& idle) { return idle->page == page.offset; });
      if (found != file.idle_.end()) std::swap(*found, file.idle_.back());
      if (!file.idle_.empty()) {
        handle = std::move(file.idle_.back());
        file.idle_.pop_back();
      }
    }
    if (!handle) handle = file.open_handle();
  }
  ~Lease() {
    const std::lock_guard lock(file.mutex_);
    if (file.idle_.size() < most_idle_handles) file.idle_.push_back(std::move(handle));
  }
  static std::string name_of(const TiffPage& page, int column, int row) {
    return page.name + (page.is_tiled
                            ? ", tile " + std::to_string(column) + ", " + std::to_string(row)
                            : ", strip " + std::to_string(row));
  }
  [[noreturn]] void fail(const TiffPage& page, int column, int row) const {
    throw LoadError(file.file_, name_of(page, column, row),
                    "cannot be decoded" + (handle->problem.empty() ? "" : ": " + handle->problem));
  }
  // Returns the bytes that a block of the first channel takes in the file; 0: it is not there.
  uint64_t find(const TiffPage& page, int column, int row) const {
    handle->problem.clear();
    if (!handle->choose(page)) fail(page, column, row);
    const uint32_t x = uint32_t(column) * uint32_t(page.block_width);
    const uint32_t y = uint32_t(row) * uint32_t(page.block_height);
    const uint32_t number = page.is_tiled ? TIFFComputeTile(handle->tiff, x, y, 0, 0)
                                          : TIFFComputeStrip(handle->tiff, y, 0);
    int wrong = 0;
    const uint64_t stored = TIFFGetStrileByteCountWithErr(handle->tiff, number, &wrong);
    if (wrong) fail(page, column, row);
    return stored;
  }
  std::vector<uint8_t> read(const TiffPage& page, int column, int row, int plane) const {
    std::vector<uint8_t> codes;
    if (!handle->read_codes(page, column, row, plane, codes)) fail(page, column, row);
    return codes;
  }
};

TiffFile::TiffFile(const std::string& file, BandView view) : file_(file), view_(std::move(view)) {
  descriptor_ = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat about {};
  if (descriptor_ < 0 || fstat(descriptor_, &about) != 0) {
    const std::string why = std::strerror(errno);
    if (descriptor_ >= 0) close(descriptor_);
    throw LoadError(file_, "", "cannot be read: " + why);
  }
  size_ = about.st_size;
}

TiffFile::~TiffFile() {
  idle_.clear();
  close(descriptor_);
}

std::unique_ptr<TiffHandle> TiffFile::open_handle() const {
  return std::make_unique<TiffHandle>(file_, descriptor_, uint64_t(size_), most_block_bytes);
}

TiffPage TiffFile::describe(TiffHandle& handle, const std::string& name, bool has_bands) const {
  const auto fail = [&](const std::string& what) { throw LoadError(file_, name, what); };
  TiffPage page;
  page.name = name;
  page.offset = TIFFCurrentDirOffset(handle.tiff);
  page.width = handle.field<uint32_t>(TIFFTAG_IMAGEWIDTH);
  page.height = handle.field<uint32_t>(TIFFTAG_IMAGELENGTH);
  const std::string size = std::to_string(page.width) + " x " + std::to_string(page.height);
  if (std::min(page.width, page.height) < 1 || std::max(page.width, page.height) > longest_picture)
    fail("picture of " + size + " texels is empty or too large");
  page.is_tiled = TIFFIsTiled(handle.tiff);
  const auto block = [&](uint32_t tag) {
    return int(std::min<uint32_t>(handle.field<uint32_t>(tag), uint32_t(longest_picture)));
  };
  page.block_width = page.is_tiled ? block(TIFFTAG_TILEWIDTH) : int(page.width);
  page.block_height = page.is_tiled ? block(TIFFTAG_TILELENGTH)
                                    : std::min(block(TIFFTAG_ROWSPERSTRIP), int(page.height));
  if (page.block_height < 1 || page.block_width < 1 ||
      (page.is_tiled && std::max(page.block_width, page.block_height) > largest_tile))
    fail("tiles of " + std::to_string(page.block_width) + " x " +
         std::to_string(page.block_height) + " texels: at most 4096 a side are read");
  page.is_planar = handle.field<uint16_t>(TIFFTAG_PLANARCONFIG, 1) == PLANARCONFIG_SEPARATE;
  page.bits = handle.field<uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
  page.channels = handle.field<uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
  const int compression = handle.field<uint16_t>(TIFFTAG_COMPRESSION, 1);
  page.most_packed = most_packed_by(compression);
  if (page.most_packed == 0)
    fail("compression " + std::to_string(compression) +
         (compression == COMPRESSION_OJPEG ? " (old-style JPEG)" : "") + " is not read");
  const int format = handle.field<uint16_t>(TIFFTAG_SAMPLEFORMAT, 1);
  const bool is_whole = format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID;
  page.is_float = format == SAMPLEFORMAT_IEEEFP && page.bits == 32;
  if (has_bands && !page.is_float && !(is_whole && (page.bits == 8 || page.bits == 16)))
    fail("bands are whole numbers of 8 or 16 bits, or floats of 32; these have " +
         std::to_string(page.bits) + " bits" + (is_whole ? "" : " of another kind"));
  if (!has_bands && (!is_whole || page.bits > 16))
    fail("only whole numbers of up to 16 bits are read");
  if (const int most = has_bands ? int(most_bands) : 5; page.channels < 1 || page.channels > most)
    fail("has " + std::to_string(page.channels) + " channels; at most " + std::to_string(most) +
         " are read");
  if (int64_t(page.block_width) * page.block_height >
      most_block_bytes / (page.channels * std::max(1, page.bits / 8)))
    fail("strips are too large");
  if (const int code = handle.field<uint16_t>(TIFFTAG_ORIENTATION, 1); code >= 1 && code <= 8)
    page.orientation.code = code;
  uint16_t extra_count = 0, *extra = nullptr;
  TIFFGetFieldDefaulted(handle.tiff, TIFFTAG_EXTRASAMPLES, &extra_count, &extra);
  const auto has_depth = [&](std::initializer_list<int> depths) {
    return std::ranges::find(depths, page.bits) != depths.end();
  };

  uint16_t photometric = 0;
  if (!TIFFGetField(handle.tiff, TIFFTAG_PHOTOMETRIC, &photometric))
    photometric = page.channels >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK;
  if (has_bands) {
    if (photometric != PHOTOMETRIC_MINISBLACK && photometric != PHOTOMETRIC_RGB)
      fail("bands need the photometric interpretation min-is-black, 1, not " +
           std::to_string(photometric));
    page.way = TiffPage::Way::bands;
    return page;
  }
  int colors = 1;
  const bool is_grey =
      photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_MINISWHITE;
  if (is_grey || photometric == PHOTOMETRIC_PALETTE) {
    page.way = TiffPage::Way::table;
    if (!has_depth({8}) && !(has_depth({1, 2, 4}) && page.channels == 1) &&
        !(has_depth({16}) && is_grey))
      fail(std::to_string(page.bits) + " bits of a channel are not read here");
    uint16_t* map[3] = {};
    if (!is_grey && !TIFFGetField(handle.tiff, TIFFTAG_COLORMAP, &map[0], &map[1], &map[2]))
      fail("has no palette");
    const int codes = 1 << std::min(page.bits, 8);
    for (int code = 0; code < codes; code++) {
      uint8_t* rgba = &page.table[size_t(code) * 4];
      const int grey = code * 255 / (codes - 1);
      for (int c = 0; c < 3; c++)
        rgba[c] = is_grey ? uint8_t(photometric == PHOTOMETRIC_MINISWHITE ? 255 - grey : grey)
                          : to_8_bits(map[c][code]);
      rgba[3] = 255;
    }
    if (profile_) profile_->convert(page.table.data(), page.table.data(), 256);
  } else if (photometric == PHOTOMETRIC_SEPARATED) {
    page.way = TiffPage::Way::cmyk, colors = 4;
  } else if (photometric == PHOTOMETRIC_RGB) {
    page.way = TiffPage::Way::rgb, colors = 3;
  } else if (photometric == PHOTOMETRIC_YCBCR && compression == COMPRESSION_JPEG &&
             !page.is_planar) {
    page.way = TiffPage::Way::rgb, colors = 3, page.converts_jpeg = true;
  } else if ((photometric == PHOTOMETRIC_YCBCR || photometric == PHOTOMETRIC_CIELAB) &&
             page.channels == 3 && page.bits == 8) {
    page.way = TiffPage::Way::any, colors = 3;
  } else {
    fail("photometric interpretation " + std::to_string(photometric) + " is not read");
  }
  if (colors > 1 && !has_depth({8, 16}))
    fail(std::to_string(page.bits) + " bits of a channel are not read here");
  if (page.channels < colors) fail("has too few channels");
  if (page.channels > colors && extra_count > 0)
    page.alpha = extra[0] == EXTRASAMPLE_ASSOCALPHA   ? TiffPage::Alpha::multiplied
                 : extra[0] == EXTRASAMPLE_UNASSALPHA ? TiffPage::Alpha::straight
                                                      : TiffPage::Alpha::none;
  const bool has_jpeg = compression == COMPRESSION_JPEG && page.is_tiled && !page.is_planar &&
                        page.bits == 8 && page.channels == colors && is_srgb_;
  if (has_jpeg && photometric == PHOTOMETRIC_MINISBLACK) page.jpeg = JpegColors::grey;
  if (has_jpeg && photometric == PHOTOMETRIC_RGB) page.jpeg = JpegColors::rgb;
  if (has_jpeg && photometric == PHOTOMETRIC_YCBCR) page.jpeg = JpegColors::ycc;
  return page;
}

std::vector<TiffPage> TiffFile::read_pages() {
  std::unique_ptr<TiffHandle> handle = open_handle();
  TIFF* tiff = handle->tiff;
  uint32_t bytes = 0;
  void* icc = nullptr;
  find_band_weights();
  const bool has_bands = bands_.has_value();
  if (!has_bands && TIFFGetField(tiff, TIFFTAG_ICCPROFILE, &bytes, &icc)) {
    const uint16_t photometric = handle->field<uint16_t>(TIFFTAG_PHOTOMETRIC);
    const ColorKind kind = photometric <= PHOTOMETRIC_MINISBLACK  ? ColorKind::grey
                           : photometric == PHOTOMETRIC_SEPARATED ? ColorKind::cmyk
                                                                  : ColorKind::rgb;
    profile_ = make_color_profile({static_cast<const uint8_t*>(icc), bytes}, kind);
    is_srgb_ = !profile_ || (kind != ColorKind::cmyk && keeps_colors(*profile_, kind));
  }
  std::vector<TiffPage> pages = {describe(*handle, "page 1", has_bands)};
  if (has_bands && size_t(pages[0].channels) != bands_->nm.size())
    throw LoadError(file_, "page 1",
                    "has " + std::to_string(pages[0].channels) + " samples a pixel for " +
                        std::to_string(bands_->nm.size()) +
                        " wavelengths; if its pages are bands, "
                        "`./wellspring import bands " +
                        file_ + "` joins them");
  const auto add_if_smaller = [&](const std::string& name) {
    TiffPage sides;
    sides.is_tiled = TIFFIsTiled(tiff);
    sides.width = handle->field<uint32_t>(TIFFTAG_IMAGEWIDTH);
    sides.height = handle->field<uint32_t>(TIFFTAG_IMAGELENGTH);
    if (!is_smaller_version(sides, pages[0])) return;
    pages.push_back(describe(*handle, name, has_bands));
    if (has_bands && pages.back().channels != pages[0].channels) pages.pop_back();
  };
  uint16_t count = 0;
  uint64_t* list = nullptr;
  std::vector<uint64_t> offsets;
  if (TIFFGetField(tiff, TIFFTAG_SUBIFD, &count, &list)) offsets.assign(list, list + count);
  if (offsets.size() > size_t(most_levels)) offsets.resize(size_t(most_levels));
  for (size_t i = 0; i < offsets.size(); i++)
    if (TIFFSetSubDirectory(tiff, offsets[i])) add_if_smaller("SubIFD " + std::to_string(i + 1));
  if (!offsets.empty() && !TIFFSetSubDirectory(tiff, pages[0].offset)) return pages;
  if (pages.size() == 1)
    for (int i = 2; i <= most_pages && TIFFReadDirectory(tiff); i++)
      add_if_smaller("page " + std::to_string(i));
  std::ranges::stable_sort(pages, std::greater(),
                           [](const TiffPage& page) { return page.width * page.height; });
  const auto same = [](const TiffPage& a, const TiffPage& b) {
    return a.width == b.width && a.height == b.height;
  };
  pages.erase(std::unique(pages.begin(), pages.end(), same), pages.end());
  if (pages.size() > size_t(most_levels)) throw LoadError(file_, "", "has too many pages");
  return pages;
}

std::vector<uint8_t> TiffFile::read_jpeg(const TiffPage& page, int column, int row) const {
  if (!page.jpeg) return {};
  const Lease lease(*this, page);
  TiffHandle& handle = *lease.handle;
  handle.problem.clear();
  if (!handle.choose(page)) return {};
  const uint32_t x = uint32_t(column) * uint32_t(page.block_width);
  const uint32_t y = uint32_t(row) * uint32_t(page.block_height);
  const uint32_t number = TIFFComputeTile(handle.tiff, x, y, 0, 0);
  int wrong = 0;
  const uint64_t stored = TIFFGetStrileByteCountWithErr(handle.tiff, number, &wrong);
  const uint64_t most = uint64_t(page.block_width) * uint64_t(page.block_height) * 4 + (1 << 16);
  if (wrong || stored == 0 || stored > most) return {};
  std::vector<uint8_t> data(stored);
  if (TIFFReadRawTile(handle.tiff, number, data.data(), tmsize_t(stored)) != tmsize_t(stored))
    return {};
  uint32_t table_bytes = 0;
  void* tables = nullptr;
  if (!TIFFGetField(handle.tiff, TIFFTAG_JPEGTABLES, &table_bytes, &tables)) table_bytes = 0;
  StoredJpeg jpeg =
      join_tiff_jpeg({static_cast<const uint8_t*>(tables), table_bytes}, data, *page.jpeg);
  const bool fits = jpeg.width == page.block_width && jpeg.height == page.block_height &&
                    jpeg.channels == page.channels;
  return fits ? std::move(jpeg.bytes) : std::vector<uint8_t>();
}

std::optional<Piece> TiffFile::read_block(const TiffPage& page, int column, int row) const {
  const Lease lease(*this, page);
  TiffHandle& handle = *lease.handle;
  if (lease.find(page, column, row) == 0) return std::nullopt;
  if (page.way == TiffPage::Way::bands) return mix_block(lease, page, column, row);
  Piece block;
  if (page.way == TiffPage::Way::any) {
    if (!handle.read_any(page, column, row, block)) lease.fail(page, column, row);
    if (profile_) profile_->convert(block.bytes.data(), block.bytes.data(), block.bytes.size() / 4);
    return block;
  }

  const int rows = page.is_tiled
                       ? page.block_height
                       : int(std::min<int64_t>(page.block_height,
                                               page.height - int64_t(row) * page.block_height));
  block = make_piece(page.block_width, rows);
  uint8_t* rgba = block.bytes.data();
  const size_t count = block.bytes.size() / 4;
  const int planes = page.is_planar ? page.channels : 1;
  const size_t colors = page.way == TiffPage::Way::table ? 1
                        : page.way == TiffPage::Way::rgb ? 3
                                                         : 4;
  const bool has_alpha = page.alpha != TiffPage::Alpha::none;
  std::vector<uint8_t> alpha(has_alpha ? count : 0), codes;
  // Channels go to their places one after the other, from whichever block they are in.
  for (int plane = 0; plane < planes; plane++) {
    codes = lease.read(page, column, row, plane);
    const size_t step = size_t(page.channels / planes);
    unpack(codes, page, rows, int(step));
    for (size_t k = 0; k < step; k++) {
      const size_t channel = size_t(plane) + k;
      if (channel < colors)
        for (size_t i = 0; i < count; i++) rgba[4 * i + channel] = codes[i * step + k];
      else if (channel == colors && has_alpha)
        for (size_t i = 0; i < count; i++) alpha[i] = codes[i * step + k];
    }
  }
  if (page.way == TiffPage::Way::table) {
    for (size_t i = 0; i < count; i++) std::memcpy(rgba + 4 * i, &page.table[rgba[4 * i] * 4u], 4);
  } else if (page.way == TiffPage::Way::cmyk) {
    const std::vector<uint8_t> inks = block.bytes;
    convert_cmyk(profile_.get(), inks.data(), rgba, count);
  }
  for (size_t i = 0; i < count; i++) rgba[4 * i + 3] = has_alpha ? alpha[i] : uint8_t(255);
  if (page.alpha == TiffPage::Alpha::multiplied) divide_by_alpha(rgba, count);
  if (page.way == TiffPage::Way::rgb && profile_) profile_->convert(rgba, rgba, count);
  return block;
}

std::vector<uint8_t> TiffFile::read_codes(const TiffPage& page, int column, int row,
                                          int channel) const {
  const Lease lease(*this, page);
  if (lease.find(page, column, row) == 0)
    throw LoadError(file_, Lease::name_of(page, column, row), "is left out");
  return lease.read(page, column, row, channel);
}

Piece TiffFile::mix_block(const Lease& lease, const TiffPage& page, int column, int row) const {
  const BandMixer mixer(*bands_, weights_, code_of(page));
  const size_t bands = bands_->nm.size();
  std::vector<std::vector<uint8_t>> planes(page.is_planar ? bands : 1);
  std::vector<BandMixer::Codes> codes(bands);
  for (size_t band = 0; band < bands; band++) {
    if (!mixer.uses(band)) continue;
    std::vector<uint8_t>& plane = planes[page.is_planar ? band : 0];
    if (plane.empty()) plane = lease.read(page, column, row, int(band));
    if (page.is_planar) codes[band] = {plane.data(), 1};
    else codes[band] = {plane.data() + band * size_t(page.bits / 8), bands};
  }
  const int rows = page.is_tiled
                       ? page.block_height
                       : int(std::min<int64_t>(page.block_height,
                                               page.height - int64_t(row) * page.block_height));
  Piece block = make_piece(page.block_width, rows);
  if (const auto wrong = mixer.mix(codes, block.bytes.size() / 4, block.bytes.data()))
    throw LoadError(file_, Lease::name_of(page, column, row),
                    "band " + std::to_string(*wrong + 1) + " has a value that is no number");
  return block;
}

}  // namespace wellspring::store
