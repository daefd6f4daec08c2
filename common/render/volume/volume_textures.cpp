#include "common/render/volume/volume_textures.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/math/lattice.h"
#include "common/render/gl/context.h"
#include "common/render/volume/table/preintegration.h"
#include "common/render/volume/volume_bindings.h"
#include "common/render/volume/voxels/axis_tables.h"
#include "common/render/volume/voxels/coarse_image.h"
#include "common/render/volume/voxels/seen_bricks.h"
#include "common/render/volume/voxels/voxel_texture.h"

namespace palpate {
namespace {

void check_size(const VolumeImage& image, int largest) {
  const Index3 n = image.points;
  if (std::max({n.x, n.y, n.z}) <= largest) return;
  throw usage_error("a volume of " + std::to_string(n.x) + "x" + std::to_string(n.y) + "x" +
                    std::to_string(n.z) +
                    " voxels with colours does not fit the driver's textures; each side is 1 to " +
                    std::to_string(largest));
}

GlTexture upload_colors(const VolumeImage& image) {
  const Index3 n = image.points;
  GlTexture texture = make_texture(GL_TEXTURE_3D, "colours of voxels");
  glTextureStorage3D(texture.name(), 1, GL_RGBA8, n.x, n.y, n.z);
  glTextureSubImage3D(texture.name(), 0, 0, 0, 0, n.x, n.y, n.z, GL_RGBA, GL_UNSIGNED_BYTE,
                      image.colors->data());
  set_voxel_sampling(texture);
  return texture;
}

std::string megabytes(std::uint64_t bytes) { return std::to_string(bytes >> 20U) + " MB"; }

// The part of the memory for voxels that each field gets.
std::uint64_t memory_of_field(const VolumeView& view) {
  std::uint64_t shown = 1;  // that of the context
  for (std::size_t field = 1; field < field_count(view); ++field) shown += shows_field(view, field) ? 1 : 0;
  return view.storage.memory / shown;
}

}  // namespace

bool VolumeTextures::TableKey::operator==(const TableKey& other) const {
  return same_places(other) && transfers == other.transfers;
}

bool VolumeTextures::TableKey::same_places(const TableKey& other) const {
  const auto same = [](const PlaceRange& a, const PlaceRange& b) {
    return a.lower == b.lower && a.upper == b.upper;
  };
  const auto alike = [](const FieldTransfer& a, const FieldTransfer& b) {
    return a.field == b.field && a.regions.has_value() == b.regions.has_value();
  };
  return std::equal(transfers.begin(), transfers.end(), other.transfers.begin(), other.transfers.end(),
                    alike) &&
         std::equal(places.begin(), places.end(), other.places.begin(), other.places.end(), same) &&
         longest == other.longest && entries == other.entries && lengths == other.lengths &&
         preintegrate == other.preintegrate;
}

void VolumeTextures::update(const VolumeView& view, const BrickSight& sight, const VolumeTextures* other) {
  PALPATE_CHECK(view.image != nullptr);
  PALPATE_CHECK(view.table_entries >= 2 && view.table_lengths >= static_cast<int>(kLengthGroup));
  if (other != nullptr) tiles_.share_program(other->tiles_);
  const std::uint64_t memory = memory_of_field(view);
  if (other != nullptr && other->image_ == view.image) {
    share_voxels(*other);
  } else {
    VolumeView first = view;
    first.storage.memory -= view.storage.memory - memory;
    place_voxels(first, sight);
  }
  if (fields_.update(view, memory, other == nullptr ? nullptr : &other->fields_)) {
    ++changes_;
    key_ = {};
  }
  const VolumeView shown = drawn(view);
  regions_ = has_regions(shown);
  update_lines(shown);
  field_count_ = field_count(shown);
  field_bricks_.assign(1, bricks());
  for (std::size_t field = 1; field < field_count_; ++field)
    field_bricks_.push_back(shows_field(shown, field) ? fields_.bricks(field).ranges().bricks : Index3(1));
  cost_.field_bytes = fields_.bytes();
  update_colors(shown);
  update_tables(shown);
}

VolumeView VolumeTextures::drawn(VolumeView view) const {
  view.image = image_;
  for (std::size_t i = 0; i < view.fields.size(); ++i) {
    if (shows_field(view, i + 1)) view.fields[i].image = fields_.image(i + 1);
  }
  return view;
}

void VolumeTextures::bind(bool colors) const {
  if (bricks_) {
    bricks_->bind();
  } else if (pinned_) {
    pinned_->bind(volume_shader::kVoxels);
  } else {
    glBindTextureUnit(volume_shader::kVoxels, voxels_->name());
  }
  glBindTextureUnit(volume_shader::kTables, tables_.name());
  glBindTextureUnit(volume_shader::kEmptyBricks, empty_bricks_.name());
  if (regions_) glBindTextureUnit(volume_shader::kRegionTables, region_tables_.name());
  fields_.bind();
  if (lines_) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, volume_shader::kAxisLines, lines_.name());
  if (colors) glBindTextureUnit(volume_shader::kColors, colors_->name());
}

void VolumeTextures::bind_voxels(std::uint32_t unit) const { glBindTextureUnit(unit, voxels_->name()); }

std::vector<std::string> VolumeTextures::shader_defines() const {
  std::vector<std::string> defines;
  if (pinned_) defines = pinned_->defines();
  if (bricks_) defines.push_back("BRICKED " + std::to_string(bricks_->layout().cells));
  if (field_count_ > 1) defines.push_back("FIELDS " + std::to_string(field_count_));
  if (regions_) defines.emplace_back("REGIONS");
  if (lines_) defines.push_back("UNEVEN " + std::to_string(line_halvings_));
  return defines;
}

void VolumeTextures::take_image(const std::shared_ptr<const VolumeImage>& image, const BrickRanges& ranges) {
  if (image_ == image) return;
  image_ = image;
  bricks_of_image_ = FieldBricks(image, ranges);
  colors_.reset();
  key_ = {};
}

void VolumeTextures::share_voxels(const VolumeTextures& other) {
  if (image_ != other.image_) {
    image_ = other.image_;
    bricks_of_image_ = other.bricks_of_image_;
    key_ = {};
  }
  colors_ = other.colors_;
  voxels_ = other.voxels_;
  pinned_ = other.pinned_;
  bricks_ = other.bricks_;
  placed_ = {};
  changes_ = other.changes_;
  cost_.voxel_bytes = 0;
}

BrickShare VolumeTextures::bricks_held() const noexcept {
  BrickShare share = bricks_ ? bricks_->share() : BrickShare{};
  share.wanted += left_out_;
  share.entered += entered_before_;
  share.left += entered_before_ - (bricks_ ? bricks_->kept() : 0);  // with the places that they had
  return share;
}

void VolumeTextures::place_voxels(const VolumeView& view, const BrickSight& sight) {
  PlaceKey wanted{.image = view.image, .storage = view.storage, .transfers = {}, .cuts = {}};
  const bool may_cut = !view.image->colors;
  const bool whole =
      !may_cut || (view.storage.brick_cells == 0 && fits_whole(*view.image, view.storage.memory));
  if (!whole) {
    // What bricks that are needed depend on.
    wanted.transfers = transfers_of(view);
    wanted.step = step_lengths(view).longest;
    wanted.opacity_length = opacity_length_of(view);
    wanted.magnified = has_magnified_parts(view);
    wanted.blended = blends_values(view);
    if (shows_planes(view)) wanted.cuts = view.cuts;
  }
  if (wanted != placed_) {
    left_out_ = 0;
    if (wanted.image != placed_.image) {
      if (making_.valid()) making_.wait();
      making_ = {};
      levels_.clear();
    }
    for (Level& level : levels_) level.needed.clear();
    placed_ = {};
    sight_.reset();
    if (whole) {
      check_size(*view.image, largest_volume_texture());
      place_whole(view.image, brick_ranges(*view.image), view.storage);
    }
  }
  if (!whole && !(sight_ == sight && lenses_ == view.lenses)) place_bricks(view, sight);
  placed_ = std::move(wanted);
}

void VolumeTextures::place_whole(const std::shared_ptr<const VolumeImage>& image, const BrickRanges& ranges,
                                 const VoxelStorage& storage) {
  if (image_ == image && (voxels_ || pinned_)) return;
  forget_bricks();
  voxels_.reset();
  pinned_ = image->byte_count() >= storage.least_pinned ? PinnedVoxels::pin(image) : nullptr;
  if (!pinned_) voxels_ = std::make_shared<const GlTexture>(upload_whole(*image));
  cost_.voxel_bytes = pinned_ ? 0 : image->byte_count();
  ++changes_;
  take_image(image, ranges);
}

// The level after the last one. A picture that need not `wait` for it goes without until it is made: false
// then.
bool VolumeTextures::add_level(const VolumeView& view, bool wait) {
  if (levels_.empty()) {
    levels_.push_back({view.image, brick_ranges(*view.image), {}});
    return true;
  }
  if (!making_.valid()) {
    making_ = std::async(std::launch::async, [fine = levels_.back().image] {
      auto image = coarse_image(*fine, 1);
      BrickRanges ranges = brick_ranges(*image);
      return Level{std::move(image), std::move(ranges), {}};
    });
  }
  if (!wait && making_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  Level made = making_.get();
  if (made.image->points == levels_.back().image->points) {
    throw usage_error("no " + megabytes(view.storage.memory) + " of memory hold a volume, however coarse");
  }
  levels_.push_back(std::move(made));
  return true;
}

// What they held has left.
void VolumeTextures::forget_bricks() {
  if (bricks_) entered_before_ += bricks_->share().entered;
  bricks_.reset();
}

// The finest level of which all that the picture looks up fits.
void VolumeTextures::place_bricks(VolumeView view, const BrickSight& sight) {
  const int largest = largest_volume_texture();
  const int cells = view.storage.brick_cells > 0 ? view.storage.brick_cells : kPoolBrickCells;
  const bool coarse = view.storage.upload > 0;
  lenses_ = view.lenses;
  FinerBricks finer;
  for (std::size_t level = 0;; ++level) {
    const bool there = level < levels_.size() || add_level(view, !coarse);
    if (!there) --level;
    Level& at = levels_[level];
    view.image = at.image;
    if (level > 0 && fits_whole(*at.image, view.storage.memory)) {
      place_whole(at.image, at.ranges, view.storage);
      sight_ = sight;
      return;
    }
    const BrickLayout layout = brick_layout(*at.image, cells);
    if (at.needed.empty()) at.needed = needed_bricks(view, at.ranges, layout);
    std::vector<std::size_t> wanted = bricks_in_sight(view, at.needed, layout, sight);
    const auto count = as_size(std::count(at.needed.begin(), at.needed.end(), true));
    if (level == 0 && coarse) finer = {count, brick_index_bytes(layout)};
    const std::size_t beside = coarse ? coarse_places(count, layout) : 0;
    const auto fit = [&](std::size_t bricks) {
      const std::uint64_t bytes = bricked_bytes(bricks + beside, layout, at.image->type, largest);
      return bytes < std::numeric_limits<std::uint64_t>::max() &&
             (view.storage.memory == 0 || bytes <= view.storage.memory);
    };
    left_out_ = 0;
    if (!fit(wanted.size())) {
      if (there) continue;
      // The most urgent ones, until there is a coarser level.
      std::size_t some = 0, too_many = wanted.size();
      while (some + 1 < too_many) {
        const std::size_t middle = some + (too_many - some) / 2;
        (fit(middle) ? some : too_many) = middle;
      }
      if (some == 0) {  // not even they
        (void)add_level(view, true);
        continue;
      }
      left_out_ = wanted.size() - some;
      wanted.resize(some);
    }
    voxels_.reset();
    pinned_.reset();
    if (!bricks_ || image_ != at.image || bricks_->layout().cells != cells || bricks_->coarse() != coarse) {
      BrickPool pool;
      if (bricks_ && coarse && bricks_.use_count() == 1) pool = std::move(*bricks_).give_pool();
      forget_bricks();
      bricks_ = std::make_shared<VoxelBricks>(at.image, layout, at.ranges, coarse, finer, std::move(pool));
      ++changes_;
    }
    const std::uint64_t before = bricks_->share().entered;
    bricks_->hold(at.needed, wanted, view.storage);
    changes_ += bricks_->share().entered != before ? 1 : 0;
    cost_.voxel_bytes = bricks_->bytes();
    take_image(at.image, at.ranges);
    sight_.reset();
    if (bricks_held().complete()) sight_ = sight;
    return;
  }
}

double VolumeTextures::fewest_samples_to_leap() const noexcept {
  constexpr double kManyGaps = 0.5, kFew = 1.0;
  return gaps_ < kManyGaps ? kFew : 0.0;
}

// One after another, those of the fields that are shown, as make_volume_block() counts them.
void VolumeTextures::update_lines(const VolumeView& view) {
  std::vector<std::shared_ptr<const VolumeImage>> images;
  for (std::size_t field = 0; field < field_count(view); ++field) {
    if (shows_field(view, field)) images.push_back(image_of(view, field));
  }
  if (images == lined_) return;
  std::vector<float> lines;
  line_halvings_ = 1;
  for (const auto& image : images)
    line_halvings_ = std::max(line_halvings_, append_axis_tables(*image, lines));
  lines_.reset();
  if (!lines.empty()) lines_ = make_buffer(std::span<const float>(lines));
  lined_ = std::move(images);
}

void VolumeTextures::update_colors(const VolumeView& view) {
  if (colors_ || !has_colored_parts(view)) return;
  PALPATE_CHECK(image_->colors->size() == image_->point_count());
  colors_ = std::make_shared<const GlTexture>(upload_colors(*image_));
  cost_.voxel_bytes += image_->colors->size() * sizeof(image_->colors->front());
}

void VolumeTextures::update_tables(const VolumeView& view) {
  TableKey wanted{.transfers = transfers_of(view), .places = {}};
  for (std::size_t field = 0; field < field_count_; ++field) {
    if (!shows_field(view, field)) continue;
    const NumberRange numbers = table_range(view, field);
    wanted.places.push_back({{numbers.lower, 0.0}, {numbers.upper, highest_row(view, field)}});
  }
  wanted.longest = step_lengths(view).longest / opacity_length_of(view);
  wanted.entries = view.table_entries;
  wanted.lengths = view.table_lengths;
  wanted.preintegrate = view.preintegrate;
  if (wanted == key_) return;

  // While one transfer function is dragged, the tables of the others stay.
  const Stopwatch clock;
  const TableKey before = std::exchange(key_, std::move(wanted));
  const bool stay = before.same_places(key_);
  if (before.entries != key_.entries || before.lengths != key_.lengths) choice_.begin();
  if (!stay) {
    allocate_tables(view);
    optical_.clear();
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const std::vector<TransferBlock> places = transfer_blocks(view, field_bricks_);
  distances_.resize(places.size());
  optical_.resize(places.size());
  cost_.tables_made = 0;
  cost_.segments_made = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (stay && before.transfers[i] == key_.transfers[i]) continue;
    const TransferBlock& place = places[i];
    distances_[i] = place.by_regions == 1 ? update_regions(view, key_.transfers[i], place)
                                          : update_preintegrated(view, key_.transfers[i], place, optical_[i]);
    const Index3 b = field_bricks_[place.field];
    glTextureSubImage3D(empty_bricks_.name(), 0, 0, 0, place.first_brick, b.x, b.y, b.z, GL_RED_INTEGER,
                        GL_UNSIGNED_BYTE, distances_[i].data());
    ++cost_.tables_made;
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  std::vector<std::uint8_t> maps;  // of the context's field
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].field == 0) maps.insert(maps.end(), distances_[i].begin(), distances_[i].end());
  }
  const std::vector<std::uint8_t>& first = distances_.front();
  cost_.empty_share =
      static_cast<double>(std::count_if(first.begin(), first.end(), [](auto d) { return d > 0; })) /
      static_cast<double>(first.size());
  tiles_.set_bricks(shell_bricks(bricks(), maps));
  gaps_ = gap_share(bricks(), maps);
  hidden_ = 0.0;
  if (!levels_.empty() && levels_.front().image != image_) {
    VolumeView finest = view;
    finest.image = levels_.front().image;
    hidden_ = hidden_share(finest, levels_.front().ranges, view, bricks_of_image_.ranges());
  }
  cost_.table_ms = 1e3 * clock.seconds();
}

void VolumeTextures::allocate_tables(const VolumeView& view) {
  tables_.reset();
  region_tables_.reset();
  cost_.table_bytes = 0;
  Index3 maps(0);
  int tables = 0, regions = 0;
  for (const TransferBlock& place : transfer_blocks(view, field_bricks_)) {
    const Index3 b = field_bricks_[place.field];
    maps = {std::max(maps.x, b.x), std::max(maps.y, b.y), maps.z + b.z};
    (place.by_regions == 1 ? regions : tables) += 1;
  }
  const auto entries = static_cast<std::uint64_t>(view.table_entries);
  if (tables > 0) {
    const int layers = view.table_lengths * tables;
    tables_ = make_texture(GL_TEXTURE_2D_ARRAY, "preintegrated tables");
    glTextureStorage3D(tables_.name(), 1, GL_RGBA16, view.table_entries, view.table_entries, layers);
    set_sampling(tables_, GL_LINEAR, GL_CLAMP_TO_EDGE);
    cost_.table_bytes += 4 * sizeof(std::uint16_t) * entries * entries * static_cast<std::uint64_t>(layers);
  }
  if (regions > 0) {
    region_tables_ = make_texture(GL_TEXTURE_2D_ARRAY, "region tables");
    glTextureStorage3D(region_tables_.name(), 1, GL_RGBA16F, view.table_entries,
                       static_cast<GLsizei>(kGradientEntries), regions);
    set_sampling(region_tables_, GL_LINEAR, GL_CLAMP_TO_EDGE);
    cost_.table_bytes +=
        4 * sizeof(std::uint16_t) * entries * kGradientEntries * static_cast<std::uint64_t>(regions);
  }
  empty_bricks_ = make_texture(GL_TEXTURE_3D, "empty bricks");
  glTextureStorage3D(empty_bricks_.name(), 1, GL_R8UI, maps.x, maps.y, maps.z);
  set_sampling(empty_bricks_, GL_NEAREST, GL_CLAMP_TO_EDGE);
  cost_.brick_bytes = count_of(maps);
}

// What of `table_` meets `changed`, to the GPU: its columns from there on of the rows before, its rows, and
// its columns up to there of the rows behind.
void VolumeTextures::upload_table(std::size_t lengths, const EntryRange& changed, std::size_t entries,
                                  int first_layer) {
  const auto n = static_cast<GLsizei>(entries), layers = static_cast<GLsizei>(lengths);
  const auto first = static_cast<GLint>(changed.first), end = static_cast<GLint>(changed.last) + 1;
  glPixelStorei(GL_UNPACK_ROW_LENGTH, n);
  glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, n);
  const auto upload = [&](GLint x, GLint y, GLsizei columns, GLsizei rows) {
    if (columns == 0 || rows == 0) return;
    const std::size_t from = 4 * (as_size(y) * entries + as_size(x));
    glTextureSubImage3D(tables_.name(), 0, x, y, first_layer, columns, rows, layers, GL_RGBA,
                        GL_UNSIGNED_SHORT, table_.data() + from);
  };
  upload(first, 0, n - first, first);
  upload(0, first, n, end - first);
  upload(0, end, end, n - end);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
}

// Where a compute shader does it, the table never crosses the bus.
void VolumeTextures::fill_table(const VolumeView& view, const std::vector<OpticalEntry>& entries,
                                EntryRange changed, int first_layer) {
  const std::size_t count = entries.size();
  const auto lengths = as_size(view.table_lengths);
  if (!view.preintegrate) {
    table_.resize(4 * count * count * lengths);
    classify_fronts(entries, lengths, table_);
    return upload_table(lengths, {0, count - 1}, count, first_layer);
  }
  const TableMaker maker =
      choice_.next(view.table_maker, GpuPreintegration::possible(count), is_software_rasteriser());
  if (choice_.timed()) {
    changed = {0, count - 1};  // both makers do the same
    glFinish();
  }
  const Stopwatch clock;
  if (maker == TableMaker::kGpu) {
    gpu_.fill(entries, lengths, tables_, first_layer, changed);
  } else {
    table_.resize(4 * count * count * lengths);
    preintegrate(entries, lengths, 0, table_, changed);
    upload_table(lengths, changed, count, first_layer);
    // Kept where a transfer function is dragged alone: it takes as much as the texture.
    if (changed == EntryRange{0, count - 1}) table_ = decltype(table_)();
  }
  if (choice_.timed()) glFinish();
  choice_.filled(1e3 * clock.seconds());
  cost_.segments_made = share_of_segments(changed, count);
}

// While one point is dragged, only what it changes is made anew.
// @param before what the table was filled with; empty: nothing. What it is filled with, then.
// @return distances between empty bricks
std::vector<std::uint8_t> VolumeTextures::update_preintegrated(const VolumeView& view,
                                                               const FieldTransfer& transfer,
                                                               const TransferBlock& place,
                                                               std::vector<OpticalEntry>& before) {
  const NumberRange numbers = table_range(view, place.field);
  const PlaceRange values = table_places(view, place.field);
  std::vector<OpticalEntry> optical = optical_entries(transfer.colors, values.lower.x, values.upper.x,
                                                      as_size(view.table_entries), key_.longest);
  const std::optional<EntryRange> changed =
      before.empty() ? EntryRange{0, optical.size() - 1} : changed_entries(before, optical);
  if (changed) fill_table(view, optical, *changed, place.first_layer);
  const BrickRanges& ranges =
      place.field == 0 ? bricks_of_image_.ranges() : fields_.bricks(place.field).ranges();
  std::vector<std::uint8_t> distances = empty_distances(ranges, optical, numbers.lower, numbers.upper);
  before = std::move(optical);
  return distances;
}

// The same. Gradients of a volume in bricks are not measured, as that would read all of it: what is seen
// there of its values with any gradient counts.
std::vector<std::uint8_t> VolumeTextures::update_regions(const VolumeView& view,
                                                         const FieldTransfer& transfer,
                                                         const TransferBlock& place) {
  const NumberRange numbers = table_range(view, place.field);
  const PlaceRange places = table_places(view, place.field);
  const RegionTable table = make_region_table(*transfer.regions, places, as_size(view.table_entries));
  glTextureSubImage3D(region_tables_.name(), 0, 0, 0, place.first_layer, view.table_entries,
                      static_cast<GLsizei>(kGradientEntries), 1, GL_RGBA, GL_FLOAT, table.entries.data());
  FieldBricks& bricks = place.field == 0 ? bricks_of_image_ : fields_.bricks(place.field);
  if (place.field == 0 && bricks_)
    return empty_distances(bricks.ranges(), deepest_entries(table), numbers.lower, numbers.upper);
  return empty_distances(bricks.ranges(), bricks.gradients(), table, numbers.lower, numbers.upper,
                         places.upper.y);
}

}  // namespace palpate
