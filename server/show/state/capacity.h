// SPDX-License-Identifier: Apache-2.0
// How many visitors a machine serves at once, by what their pictures are found to cost. One for all
// exhibits of a process: whoever is shown pictures has a Seat; newcomers for whom there is none
// wait (museum/reception.h). All calls may come from any thread.
#pragma once
#include <memory>
#include <mutex>

namespace wellspring {

struct CapacitySettings {
  double rate = 15;  // pictures a second that everybody is to have who walks
  int most = 1000;   // visitors, whatever they cost
  double cores = 0;  // of the machine; 0: those that this process may use
};

// Core-seconds of processor time for each pixel of the visitor's picture: of one that is shown
// (warped and encoded), and of a keyframe of that size. A machine that is busy with other programs
// so admits as many as before.
struct PictureCost {
  double shown = 2.5e-8, drawn = 1e-7;
  bool operator==(const PictureCost&) const = default;
};

// Cores that visitors take who walk all the time, for each pixel of their pictures; see
// weighed_pixels().
double cores_a_pixel(const PictureCost& cost, double rate);
// What a picture costs besides its pixels, as more of these.
double weighed_pixels(double pixels);

class Capacity;

// A visitor's room, until it is destroyed.
class Seat {
 public:
  ~Seat();
  Seat(const Seat&) = delete;
  Seat& operator=(const Seat&) = delete;
  void resize(double pixels);  // of the visitor's picture from now on

 private:
  friend class Capacity;
  Seat(std::shared_ptr<Capacity> capacity, double weight)
      : capacity_(std::move(capacity)), weight_(weight) {}
  const std::shared_ptr<Capacity> capacity_;
  double weight_;
};

class Capacity : public std::enable_shared_from_this<Capacity> {
 public:
  explicit Capacity(const CapacitySettings& settings = {});
  // What a picture of so many pixels took, in core-seconds.
  void note_shown(double pixels, double seconds);
  void note_drawn(double pixels, double seconds);
  // Null: there is none for so large a picture. The first visitor always gets one.
  std::unique_ptr<Seat> find_seat(double pixels);
  std::unique_ptr<Seat> give_seat(double pixels);  // whether there is one or not
  struct Standing {
    int seats = 0;               // taken
    double busy = 0, cores = 0;  // that they take if all of them walk; that there are for it
    PictureCost cost;
  };
  Standing standing() const;
  // How many visitors with pictures of so many pixels there are seats for, with those who are
  // there.
  int seats_for(double pixels) const;

 private:
  friend class Seat;
  struct Measured {
    double value = 0;
    int count = 0;
    void note(double sample);
  };
  void weigh(double more, int seats);
  std::unique_ptr<Seat> seat(double pixels, bool always);
  const CapacitySettings settings_;
  const double cores_;
  mutable std::mutex mutex_;
  Measured shown_{PictureCost{}.shown}, drawn_{PictureCost{}.drawn};
  double weight_ = 0;  // of all seats
  int seats_ = 0;
};

}  // namespace wellspring
