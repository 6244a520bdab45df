// SPDX-License-Identifier: Apache-2.0
// Finds how many visitors a machine serves at once, by the measured cost of their pictures and by
// the memory that they take. One Capacity serves all exhibits of a process: whoever is shown
// pictures has a Seat; newcomers who get none wait (museum/reception.h), and whoever wants larger
// pictures asks anew. All calls may come from any thread.
//
// Seats are shared among addresses: a newcomer from an address without seats may take a little more
// than others may, so that no address keeps others out, however much it takes.
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace wellspring::show {

struct CapacitySettings {
  double rate = 15;  // pictures a second for everybody who walks
  // visitors at most, whatever they cost; one address gets seven eighths of these seats
  int most = 1000;
  double cores = 0;   // cores of the machine; 0: those that this process may use
  double memory = 0;  // bytes for all visitors; 0: memory_share of what this process may use
};
inline constexpr double memory_share =
    0.6;  // the rest is for exhibits, sockets and what is not counted

// Holds core-seconds of processor time for each pixel of the visitor's picture: for one that is
// shown (warped and encoded), for a keyframe of that size, and for encoding the keyframe for a page
// that draws by itself. A machine that is busy with other programs thus admits as many visitors as
// before.
struct PictureCost {
  double shown = 2.5e-8, drawn = 1e-7, sent = 1.2e-8;
  bool operator==(const PictureCost&) const = default;
};

// Holds the size of somebody's pictures. local: the page draws by itself.
struct SeatSize {
  double pixels = 0;
  bool local = false;
  SeatSize(double pixels, bool local = false) : pixels(pixels), local(local) {}
};

// Returns the cores that visitors take who walk all the time, for each pixel of their pictures; see
// weighed_pixels().
double cores_a_pixel(const PictureCost& cost, double rate, bool local);
// Adds to the pixels what a picture costs besides, expressed in pixels.
double weighed_pixels(double pixels);
// Returns about how many bytes a visitor takes: a little more than picture_memory() finds.
double visitor_bytes(double pixels);

class Capacity;

// A seat is a visitor's share of the machine, until it is destroyed.
class Seat {
 public:
  ~Seat();
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;
  // Gives the visitor pictures of this size from now on. Returns false if there is no room for more
  // pixels; then nothing changes.
  bool resize(SeatSize size);

 private:
  friend class Capacity;
  Seat(std::shared_ptr<Capacity> capacity, SeatSize size, std::string address, bool always)
      : capacity_(std::move(capacity)),
        size_(size),
        address_(std::move(address)),
        always_(always) {}
  const std::shared_ptr<Capacity> capacity_;
  SeatSize size_;
  const std::string address_;
  const bool always_;  // whether it was given without regard to room
};

class Capacity : public std::enable_shared_from_this<Capacity> {
 public:
  explicit Capacity(const CapacitySettings& settings = {});
  // Each notes what a picture of so many pixels took, in core-seconds.
  void note_shown(double pixels, double seconds);
  void note_drawn(double pixels, double seconds);
  void note_sent(double pixels, double seconds);
  // Returns null if there is no room for so large a picture. The first visitor always gets a seat.
  // An empty address shares with nobody.
  std::unique_ptr<Seat> find_seat(SeatSize size, const std::string& address = {});
  std::unique_ptr<Seat> give_seat(SeatSize size);  // gives one, whether there is room or not
  int seats_of(const std::string& address) const;  // number of taken seats
  struct Standing {
    int seats = 0;  // number of taken seats
    // cores that visitors take if all of them walk; cores that there are
    double busy = 0, cores = 0;
    double bytes = 0, memory = 0;  // likewise
    PictureCost cost;
  };
  Standing standing() const;
  // Returns how many visitors with such pictures there are seats for, including present ones.
  int seats_for(SeatSize size) const;

 private:
  friend class Seat;
  struct Measured {
    double value = 0;
    int count = 0;
    void note(double sample);
  };
  struct Part {  // sums over some visitors
    int seats = 0;
    double shown_weight = 0, local_weight = 0;  // weighed pixels of either kind of picture
    double bytes = 0;
    void add(SeatSize size, int count);
  };
  // All these are called with the lock held.
  double cores_of(SeatSize size) const;
  double cores_of(const Part& part) const;
  bool fits(SeatSize size, const std::string& address) const;
  bool may_grow(const Seat& seat, SeatSize size) const;
  void add(SeatSize size, const std::string& address, int count);
  double taken_cores(bool from_elsewhere) const;
  std::unique_ptr<Seat> seat(SeatSize size, const std::string& address, bool always);
  const CapacitySettings settings_;
  const double cores_, memory_;
  mutable std::mutex mutex_;
  PictureCost cost() const { return {shown_.value, drawn_.value, sent_.value}; }
  Measured shown_{PictureCost{}.shown}, drawn_{PictureCost{}.drawn}, sent_{PictureCost{}.sent};
  Part all_;
  std::map<std::string, Part> parts_;  // by address
};

}  // namespace wellspring::show
