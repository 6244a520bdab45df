// SPDX-License-Identifier: Apache-2.0
// How many visitors a machine serves at once, by what their pictures are found to cost, and by the
// memory that they take. One for all exhibits of a process: whoever is shown pictures has a Seat;
// newcomers for whom there is none wait (museum/reception.h), and whoever wants larger pictures
// asks anew. All calls may come from any thread.
//
// Seats are shared among addresses: who comes from one that has none may take a little more than
// what is kept for all, so that no address keeps others out, however much it takes.
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace wellspring::show {

struct CapacitySettings {
  double rate = 15;   // pictures a second that everybody is to have who walks
  int most = 1000;    // visitors, whatever they cost; an address gets seven eighths of these seats
  double cores = 0;   // of the machine; 0: those that this process may use
  double memory = 0;  // bytes for all visitors; 0: memory_share of what this process may use
};
inline constexpr double memory_share =
    0.6;  // exhibits, sockets and what nobody counts have the rest

// Core-seconds of processor time for each pixel of the visitor's picture: of one that is shown
// (warped and encoded), of a keyframe of that size, and of encoding that for a page that draws by
// itself. A machine that is busy with other programs so admits as many as before.
struct PictureCost {
  double shown = 2.5e-8, drawn = 1e-7, sent = 1.2e-8;
  bool operator==(const PictureCost&) const = default;
};

// Tells what somebody's pictures are. local: the page draws by itself.
struct SeatSize {
  double pixels = 0;
  bool local = false;
  SeatSize(double pixels, bool local = false) : pixels(pixels), local(local) {}
};

// Cores that visitors take who walk all the time, for each pixel of their pictures; see
// weighed_pixels().
double cores_a_pixel(const PictureCost& cost, double rate, bool local);
// What a picture costs besides its pixels, as more of these.
double weighed_pixels(double pixels);
// Bytes that a visitor takes, about: as picture_memory() finds it, and some.
double visitor_bytes(double pixels);

class Capacity;

// A visitor's room, until it is destroyed.
class Seat {
 public:
  ~Seat();
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;
  // The visitor's pictures are these from now on; false: there is no room for more pixels, and
  // nothing has changed.
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
  const bool always_;  // whether there is room or not
};

class Capacity : public std::enable_shared_from_this<Capacity> {
 public:
  explicit Capacity(const CapacitySettings& settings = {});
  // What a picture of so many pixels took, in core-seconds.
  void note_shown(double pixels, double seconds);
  void note_drawn(double pixels, double seconds);
  void note_sent(double pixels, double seconds);
  // Null: there is none for so large a picture. The first visitor always gets one. An empty address
  // shares with nobody.
  std::unique_ptr<Seat> find_seat(SeatSize size, const std::string& address = {});
  std::unique_ptr<Seat> give_seat(SeatSize size);  // whether there is one or not
  int seats_of(const std::string& address) const;  // taken
  struct Standing {
    int seats = 0;                 // taken
    double busy = 0, cores = 0;    // that they take if all of them walk; that there are for it
    double bytes = 0, memory = 0;  // likewise
    PictureCost cost;
  };
  Standing standing() const;
  // How many visitors with such pictures there are seats for, with those who are there.
  int seats_for(SeatSize size) const;

 private:
  friend class Seat;
  struct Measured {
    double value = 0;
    int count = 0;
    void note(double sample);
  };
  struct Part {  // what some visitors have together
    int seats = 0;
    double shown_weight = 0, local_weight = 0;  // weighed pixels of either kind of picture
    double bytes = 0;
    void add(SeatSize size, int count);
  };
  // All with the lock held.
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
