// SPDX-License-Identifier: Apache-2.0
// Holds what draws the pictures of a running show, and how fast it was measured to be.
#pragma once
#include "picture/warp_picture.h"
#include "show/state/renderer.h"
#include "show/state/visitor_attention.h"

namespace wellspring::show {

struct ShowDrawing {
  double drew_at = 0;                 // show time when anything was last drawn, traced or lit
  bool others_draw = false;           // others than this show's visitors need the cores
  float picture_lead = 0.02f;         // seconds from a tick to the times of its pictures, smoothed
  float samples_per_second = 200000;  // measured, of all cores
  WarpScratch warp;  // shared by all visitors, whose pictures are warped one after the other
  StillPass pass;
  AttentionAnalysis analysis;  // show/draw/steer.h
  Renderer renderer;           // the last member: it reads the others while it is at work
};

}  // namespace wellspring::show
