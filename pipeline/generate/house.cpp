// A town house: windows with glazing bars and louvered shutters, balconies, a shop with an awning, a tiled
// roof.
#include "pipeline/generate/house.h"

#include <algorithm>

#include "pipeline/generate/ironwork.h"

namespace hwsim::pipeline::generate {
namespace {
using glm::dvec3;

constexpr double kRecess = 0.18, kTilesPerM = 0.5;

struct Box {
  double x0, y0, x1, y1;
};

class HouseBuilder {
 public:
  HouseBuilder(Pcg& random, const HouseShape& shape) : random_(random), shape_(shape) {
    const HouseLooks& l = shape.looks;
    for (const int look : {l.wall, l.stone, l.wood, l.glass, l.iron, l.roof, l.cloth})
      model_.pieces.push_back({MeshSurface{}, look});
    model_.name = "house";
  }

  Model build() {
    const double half = 0.5 * shape_.bays * shape_.bay_m, height = shape_.floors * shape_.floor_m;
    for (int floor = 0; floor < shape_.floors; ++floor)
      for (int bay = 0; bay < shape_.bays; ++bay) {
        const double x = -half + bay * shape_.bay_m, y = floor * shape_.floor_m;
        const Box cell{x, y, x + shape_.bay_m, y + shape_.floor_m};
        if (floor == 0)
          add_ground_bay(cell, bay == shape_.bays / 2);
        else
          add_upper_bay(cell);
      }
    for (int floor = 1; floor <= shape_.floors; ++floor) {
      const double y = floor * shape_.floor_m, out = floor == shape_.floors ? 0.3 : 0.06;
      add_box(stone(), {-half, y - 0.14, -0.02}, {half, y, out});
    }
    add_quad(wall(), {-half, 0, -shape_.depth_m}, {-half, 0, 0}, {-half, height, 0},
             {-half, height, -shape_.depth_m}, kTilesPerM);
    add_quad(wall(), {half, 0, 0}, {half, 0, -shape_.depth_m}, {half, height, -shape_.depth_m},
             {half, height, 0}, kTilesPerM);
    add_quad(wall(), {half, 0, -shape_.depth_m}, {-half, 0, -shape_.depth_m},
             {-half, height, -shape_.depth_m}, {half, height, -shape_.depth_m}, kTilesPerM);
    add_roof(half, height);
    return std::move(model_);
  }

 private:
  MeshSurface& wall() { return model_.pieces[0].surface; }
  MeshSurface& stone() { return model_.pieces[1].surface; }
  MeshSurface& wood() { return model_.pieces[2].surface; }
  MeshSurface& glass() { return model_.pieces[3].surface; }
  MeshSurface& iron() { return model_.pieces[4].surface; }
  MeshSurface& roof() { return model_.pieces[5].surface; }
  MeshSurface& cloth() { return model_.pieces[6].surface; }

  void add_front(const Box& b, double z, MeshSurface& s) {
    if (b.x1 > b.x0 && b.y1 > b.y0)
      add_quad(s, {b.x0, b.y0, z}, {b.x1, b.y0, z}, {b.x1, b.y1, z}, {b.x0, b.y1, z}, kTilesPerM);
  }

  // The wall of a cell around an opening, the opening's reveal, and a pane at its back.
  void add_opening(const Box& cell, const Box& o) {
    add_front({cell.x0, cell.y0, o.x0, cell.y1}, 0, wall());
    add_front({o.x1, cell.y0, cell.x1, cell.y1}, 0, wall());
    add_front({o.x0, cell.y0, o.x1, o.y0}, 0, wall());
    add_front({o.x0, o.y1, o.x1, cell.y1}, 0, wall());
    const auto at = [](double x, double y, double z) { return dvec3(x, y, z); };
    add_quad(stone(), at(o.x0, o.y0, 0), at(o.x0, o.y0, -kRecess), at(o.x0, o.y1, -kRecess),
             at(o.x0, o.y1, 0));
    add_quad(stone(), at(o.x1, o.y0, -kRecess), at(o.x1, o.y0, 0), at(o.x1, o.y1, 0),
             at(o.x1, o.y1, -kRecess));
    add_quad(stone(), at(o.x0, o.y1, -kRecess), at(o.x1, o.y1, -kRecess), at(o.x1, o.y1, 0),
             at(o.x0, o.y1, 0));
    add_quad(stone(), at(o.x0, o.y0, 0), at(o.x1, o.y0, 0), at(o.x1, o.y0, -kRecess),
             at(o.x0, o.y0, -kRecess));
    add_front(o, -kRecess, glass());
    constexpr double kTrim = 0.1, kOut = 0.04;
    add_box(stone(), {o.x0 - kTrim, o.y0, 0}, {o.x0, o.y1 + kTrim, kOut});
    add_box(stone(), {o.x1, o.y0, 0}, {o.x1 + kTrim, o.y1 + kTrim, kOut});
    add_box(stone(), {o.x0, o.y1, 0}, {o.x1, o.y1 + kTrim, kOut});
  }

  // Glazing bars: a grid of thin boxes in front of the pane.
  void add_bars(const Box& o, int columns, int rows) {
    constexpr double kThick = 0.016, kFront = -kRecess + 0.05;
    for (int i = 0; i <= columns; ++i) {
      const double x = o.x0 + (o.x1 - o.x0) * i / columns, t = i == 0 || i == columns ? 3 * kThick : kThick;
      add_box(wood(), {x - t / 2, o.y0, -kRecess}, {x + t / 2, o.y1, kFront});
    }
    for (int i = 0; i <= rows; ++i) {
      const double y = o.y0 + (o.y1 - o.y0) * i / rows, t = i == 0 || i == rows ? 3 * kThick : kThick;
      add_box(wood(), {o.x0, y - t / 2, -kRecess}, {o.x1, y + t / 2, kFront});
    }
  }

  // An open leaf flat on the wall: a frame and tilted slats.
  void add_shutter(double x0, double x1, double y0, double y1) {
    constexpr double kFrame = 0.05, kBack = 0.045, kFront = 0.085;
    add_box(wood(), {x0, y0, kBack}, {x0 + kFrame, y1, kFront});
    add_box(wood(), {x1 - kFrame, y0, kBack}, {x1, y1, kFront});
    add_box(wood(), {x0 + kFrame, y0, kBack}, {x1 - kFrame, y0 + kFrame, kFront});
    add_box(wood(), {x0 + kFrame, y1 - kFrame, kBack}, {x1 - kFrame, y1, kFront});
    const double a = x0 + kFrame, b = x1 - kFrame, low = y0 + kFrame;
    const double pitch = (y1 - kFrame - low) / shape_.shutter_slats;
    for (int i = 0; i < shape_.shutter_slats; ++i) {
      const double y = low + pitch * i, top = y + 0.85 * pitch;
      add_quad(wood(), {a, y, kFront}, {b, y, kFront}, {b, top, kBack}, {a, top, kBack});
      add_quad(wood(), {a, y - 0.15 * pitch, kFront}, {b, y - 0.15 * pitch, kFront}, {b, y, kFront},
               {a, y, kFront});
    }
  }

  void add_balcony(double x0, double x1, double y) {
    constexpr double kOut = 0.75;
    add_box(stone(), {x0, y - 0.12, 0}, {x1, y, kOut});
    RailingShape shape;
    shape.bars_per_m = shape_.bars_per_m;
    shape.sides = shape_.sides;
    const double z = kOut - 0.05;
    add_railing(iron(), {x0 + 0.04, y, z}, {x1 - 0.04, y, z}, shape);
    shape.scrolls = false;
    add_railing(iron(), {x0 + 0.04, y, 0.02}, {x0 + 0.04, y, z}, shape);
    add_railing(iron(), {x1 - 0.04, y, 0.02}, {x1 - 0.04, y, z}, shape);
    for (const double x : {x0 + 0.25, x1 - 0.25})
      add_scroll(stone(), {x, y - 0.38, 0.02}, {0, 0, 1}, {0, 1, 0}, 0.45, 0.05, 12, shape_.sides);
  }

  void add_upper_bay(const Box& cell) {
    const bool balcony = random_.below(3) == 0;
    const double middle = 0.5 * (cell.x0 + cell.x1), half = 0.22 * shape_.bay_m;
    const Box o{middle - half, cell.y0 + (balcony ? 0.02 : 0.85), middle + half,
                cell.y0 + 0.8 * shape_.floor_m};
    add_opening(cell, o);
    add_bars(o, 2, balcony ? 5 : 3);
    if (balcony) {
      add_balcony(cell.x0 + 0.08 * shape_.bay_m, cell.x1 - 0.08 * shape_.bay_m, cell.y0);
    } else {
      add_box(stone(), {o.x0 - 0.15, o.y0 - 0.08, 0}, {o.x1 + 0.15, o.y0, 0.16});
      add_railing(iron(), {o.x0, o.y0, 0.1}, {o.x1, o.y0, 0.1},
                  {0.35, shape_.bars_per_m, 0.006, shape_.sides, false, false});
    }
    const double leaf = 0.95 * half;
    add_shutter(o.x0 - 0.11 - leaf, o.x0 - 0.11, o.y0, o.y1);
    add_shutter(o.x1 + 0.11, o.x1 + 0.11 + leaf, o.y0, o.y1);
  }

  void add_ground_bay(const Box& cell, bool door) {
    const double inset = door ? 0.28 * shape_.bay_m : 0.12 * shape_.bay_m;
    const Box o{cell.x0 + inset, door ? cell.y0 : cell.y0 + 0.5, cell.x1 - inset,
                cell.y0 + 0.78 * shape_.floor_m};
    add_opening(cell, o);
    add_bars(o, door ? 2 : 4, door ? 6 : 3);
    if (!door && random_.below(2) == 0) add_awning(o);
  }

  void add_awning(const Box& o) {
    const double out = 1.1, drop = 0.5, y = o.y1 + 0.12;
    constexpr int kWaves = 8;
    add_grid(cloth(), 6 * kWaves, 4, false, false, [&](double u, double v) {
      const double sag = 0.06 * exact_sin(kPi * u) * exact_sin(kPi * (1 - v));
      return dvec3(o.x0 - 0.1 + u * (o.x1 - o.x0 + 0.2), y - drop * (1 - v) - sag, 0.05 + out * (1 - v));
    });
    add_grid(cloth(), 6 * kWaves, 1, false, false, [&](double u, double v) {
      const double scallop = 0.05 * exact_cos(2 * kPi * kWaves * u);
      return dvec3(o.x0 - 0.1 + u * (o.x1 - o.x0 + 0.2), y - drop - (1 - v) * (0.2 + scallop), 0.05 + out);
    });
    for (const double x : {o.x0 - 0.08, o.x1 + 0.08})
      add_tube(iron(), {{x, y - drop - 0.35, 0.02}, {x, y - drop, 0.03 + out}}, 0.012, shape_.sides, true);
  }

  // Two slopes of round tiles, a chimney, and a gutter.
  void add_roof(double half, double height) {
    const double rise = 1.6 + random_.uniform(0.0, 0.6), ridge_z = -0.5 * shape_.depth_m;
    const int tiles = std::max(1, static_cast<int>(2 * half / 0.25));
    for (const double side : {1.0, -1.0}) {
      const double eave_z = side > 0 ? 0.45 : -shape_.depth_m - 0.45;
      add_grid(roof(), 6 * tiles, 8, false, false, [&](double u, double v) {
        const double x = side * (u - 0.5) * 2 * (half + 0.1);
        const double wave = exact_cos(2 * kPi * tiles * u);
        return dvec3(x, height + rise * v - 0.12 * (1 - v) + 0.035 * wave, eave_z + (ridge_z - eave_z) * v);
      });
    }
    for (const double side : {-1.0, 1.0}) {
      const double x = side * half;
      const dvec3 front(x, height, 0), back(x, height, -shape_.depth_m), top(x, height + rise, ridge_z);
      add_triangle(wall(), side > 0 ? front : back, side > 0 ? back : front, top);
    }
    add_tube(iron(), {{-half, height - 0.1, 0.47}, {half, height - 0.1, 0.47}}, 0.07, 2 * shape_.sides, true);
    const double x = random_.uniform(-0.6, 0.6) * half;
    add_box(wall(), {x - 0.35, height, ridge_z - 1.2}, {x + 0.35, height + rise + 0.8, ridge_z - 0.6});
  }

  Pcg& random_;
  const HouseShape& shape_;
  Model model_;
};

}  // namespace

Model house_model(Pcg& random, const HouseShape& shape) { return HouseBuilder(random, shape).build(); }

}  // namespace hwsim::pipeline::generate
