// A room below the roof: slanted plain walls, a skylight, a floor of boards, a bed with a
// quilt, a low shelf, a chest with a lamp.
#version 3.7;
#include "begin.inc"
#include "furniture.inc"

#declare W = 2.15;   // low walls at x = -W and x = W, Knee high
#declare Knee = 0.85;
#declare D = 4.3;    // gable at z = D
#declare H = 2.40;   // ceiling; roofs rise by 45 degrees up to it

#declare T_Roof = Flat(<0.80, 0.78, 0.74>)
#declare T_Wall = Flat(<0.72, 0.66, 0.56>)
#declare T_Trim = Glossy(<0.82, 0.80, 0.76>, 0.10)
#declare T_Chest = Glossy(<0.30, 0.40, 0.40>, 0.12)
#declare T_Linen = Flat(<0.80, 0.79, 0.76>)
#declare T_Black = Glossy(<0.05, 0.045, 0.04>, 0.2)
#declare T_Boards = texture {
  pigment {
    wood turbulence 0.08 octaves 4 scale <0.05, 0.05, 1.6> rotate <1, 2, 0>
    color_map {
      [0.00 rgb <0.50, 0.35, 0.21>]
      [0.60 rgb <0.46, 0.315, 0.185>]
      [1.00 rgb <0.42, 0.28, 0.16>]
    }
  }
  finish { diffuse 0.8 specular 0.12 roughness 0.03 reflection { 0.01, 0.12 falloff 3 } }
}
#declare T_Chair = texture {
  Picture("chair.png") scale 0.42 rotate <33, 0, 0> rotate <0, 40, 0>
}

// Puts what lies on a wall that faces -z, its middle at the origin, onto the right roof
// at the height Y; its top upwards.
#macro OnRoof(Y) rotate x * -45 rotate y * 90 translate <W + Knee - (Y), Y, 0> #end

#if (Colour)
  // The skylight, and a lamp on the chest.
  light_source {
    <W + Knee - 1.62 - 0.06, 1.62 - 0.06, 1.75> rgb <0.62, 0.68, 0.76> * 1.15
    area_light <-0.62, 0.62, 0>, <0, 0, 0.72>, 4, 4 adaptive 1
    fade_distance 1.6 fade_power 1.5
  }
  light_source {
    <-0.62, 1.22, D - 0.30> rgb <0.80, 0.55, 0.28> * 0.32
    area_light <0.08, 0, 0>, <0, 0, 0.08>, 2, 2
    fade_distance 0.8 fade_power 2
  }
  light_source { <0, 1.5, -1.0> rgb <0.045, 0.043, 0.040> shadowless }
#end

#declare Shell = union {
  plane { z, D Skin(T_Wall) }
  plane { z, -2.2 Skin(T_Wall) }
  plane { x, -W Skin(T_Roof) }
  plane { x, W Skin(T_Roof) }
  plane { <1, 1, 0>, (W + Knee) / sqrt(2) Skin(T_Roof) }
  plane { <-1, 1, 0>, (W + Knee) / sqrt(2) Skin(T_Roof) }
  plane { y, H Skin(T_Roof) }
  // Boards of 14 cm, with gaps.
  #local R = seed(41);
  #local I = -16;
  #while (I < 16)
    box {
      <0, -0.02, -2.3>, <0.138, 0, D + 0.1>
      Skin(texture { T_Boards translate <rand(R), rand(R), 5 * rand(R)> })
      translate x * 0.14 * I
    }
    #local I = I + 1;
  #end
  plane { y, -0.012 Skin(Flat(<0.08, 0.05, 0.03>)) }
  box { <-W, 0, D - 0.014>, <W, 0.08, D> Skin(T_Trim) }
  box { <-W, 0, -2.2>, <-W + 0.014, 0.08, D> Skin(T_Trim) }
  box { <W - 0.014, 0, -2.2>, <W, 0.08, D> Skin(T_Trim) }
  // A collar beam below the ceiling.
  box { <-1.2, 2.12, 2.90>, <1.2, 2.28, 3.02> Skin(texture { T_Wood rotate y * 90 }) }
}

#declare Skylight = union {
  difference {
    box { <-0.45, -0.55, -0.03>, <0.45, 0.55, 0.01> }
    box { <-0.38, -0.48, -1>, <0.38, 0.48, 1> }
    Skin(T_Trim)
  }
  // The overcast sky; frosted, so that its depth is that of the pane.
  box {
    <-0.38, -0.48, -0.005>, <0.38, 0.48, 0.01>
    Skin(texture {
      pigment { bozo scale 0.5 color_map { [0 rgb <0.80, 0.86, 0.95>] [1 rgb <0.92, 0.94, 0.98>] } }
      finish { diffuse 0.1 emission 1.3 }
    })
  }
  cylinder { <-0.10, -0.50, -0.05>, <0.10, -0.50, -0.05>, 0.010 Skin(T_Metal) }
}

#declare Bed = union {
  // Along the left wall, 0.95 wide, its foot to -z; the middle of its long side at x = 0.
  box { <0, 0.10, -1.0>, <0.95, 0.30, 1.0> Skin(texture { T_Wood }) }
  box { <0, 0, 0.97>, <0.95, 0.75, 1.02> Skin(texture { T_Wood rotate y * 90 }) }
  object { Round(<0.02, 0.28, -0.98>, <0.93, 0.46, 0.96>, 0.05) Skin(T_Linen) }
  object {
    Round(<-0.01, 0.26, -1.0>, <0.97, 0.50, 0.36>, 0.06)
    Skin(texture { Picture("quilt.png") scale 1.5 rotate x * 75 rotate y * 12 })
  }
  object { Cushion(0.55, 0.20) scale <1.1, 0.8, 1> rotate x * 58 translate <0.45, 0.60, 0.68> Skin(T_Linen) }
  object {
    Cushion(0.38, 0.15)
    #if (Colour) texture { Picture("leafy.png") scale 0.5 translate <-0.25, -0.25, 0> } #end
    rotate x * 40 rotate y * 20 translate <0.58, 0.66, 0.42>
  }
}

#declare Chest = union {
  // Three plain drawers; the middle of its foot against a wall that faces -z.
  box { <-0.50, 0.06, -0.44>, <0.50, 0.80, 0> Skin(T_Chest) }
  object { Round(<-0.53, 0.80, -0.47>, <0.53, 0.825, 0>, 0.004) Skin(T_Chest) }
  #local I = 0;
  #while (I < 3)
    object { Round(<-0.48, 0.09 + 0.235 * I, -0.456>, <0.48, 0.315 + 0.235 * I, -0.43>, 0.003) Skin(T_Chest) }
    cylinder { <-0.25, 0.205 + 0.235 * I, -0.455>, <-0.25, 0.205 + 0.235 * I, -0.48>, 0.014 Skin(T_Metal) }
    cylinder { <0.25, 0.205 + 0.235 * I, -0.455>, <0.25, 0.205 + 0.235 * I, -0.48>, 0.014 Skin(T_Metal) }
    #local I = I + 1;
  #end
  box { <-0.46, 0, -0.40>, <0.46, 0.06, -0.04> Skin(T_Black) }
}

#declare Lamp = union {
  cylinder { <0, 0, 0>, <0, 0.02, 0>, 0.075 Skin(T_Metal) }
  cylinder { <0, 0, 0>, <0, 0.30, 0>, 0.012 Skin(T_Metal) }
  cone {
    <0, 0.26, 0>, 0.15, <0, 0.46, 0>, 0.10 open no_shadow
    Skin(texture { pigment { rgb <0.85, 0.70, 0.48> } finish { diffuse 0.5 emission <0.75, 0.55, 0.32> * 0.8 } })
  }
}

#declare LowShelf = union {
  // Along the right wall: its front at z = 0, 0.74 high.
  box { <-0.90, 0, 0>, <0.90, 0.03, 0.28> }
  box { <-0.90, 0.36, 0>, <0.90, 0.38, 0.28> }
  box { <-0.90, 0.70, 0>, <0.90, 0.73, 0.28> }
  box { <-0.90, 0, 0>, <-0.875, 0.73, 0.28> }
  box { <0.875, 0, 0>, <0.90, 0.73, 0.28> }
  box { <-0.012, 0, 0>, <0.012, 0.73, 0.28> }
  box { <-0.90, 0, 0.27>, <0.90, 0.73, 0.28> }
  Skin(T_Trim)
}

#declare Armchair = union {
  object { Round(<-0.30, 0.22, -0.32>, <0.30, 0.44, 0.28>, 0.05) }
  object { Round(<-0.36, 0.18, -0.30>, <-0.27, 0.60, 0.34>, 0.04) }
  object { Round(<0.27, 0.18, -0.30>, <0.36, 0.60, 0.34>, 0.04) }
  object { Round(<-0.34, 0, -0.07>, <0.34, 0.60, 0.07>, 0.06) rotate x * 14 translate <0, 0.34, 0.30> }
  Skin(T_Chair)
}

#declare Everything = union {
  object { Shell }
  object { Skylight OnRoof(1.62) translate z * 1.75 }
  object { Bed translate <-W + 0.02, 0, 2.30> }
  object { Chest translate <-0.25, 0, D - 0.005> }
  object { Lamp translate <-0.62, 0.825, D - 0.30> }
  union { ShelfOfBooks(0, 0.30, 0.22) translate <-0.05, 0.825, D - 0.26> }
  object { Framed("landscape.png", 0.72, 0.47, 0.03, texture { T_Wood rotate y * 90 }) translate <0.02, 1.62, D> }
  object { Framed("print.png", 0.30, 0.40, 0.018, T_Black) translate <1.02, 1.42, D> }
  union {
    object { LowShelf }
    union { ShelfOfBooks(-0.86, -0.10, 0.30) translate <0, 0.03, 0.03> }
    union { ShelfOfBooks(0.05, 0.84, 0.29) translate <0, 0.38, 0.03> }
    union { ShelfOfBooks(-0.86, -0.45, 0.27) translate <0, 0.38, 0.03> }
    box { <0.10, 0.03, 0.03>, <0.42, 0.28, 0.26> Skin(Flat(<0.50, 0.42, 0.30>)) }
    rotate y * 90 translate <W - 0.30, 0, 2.55>
  }
  union { object { Armchair }
    union {
      cylinder { <-0.27, 0, -0.24>, <-0.27, 0.24, -0.24>, 0.018 }
      cylinder { <0.27, 0, -0.24>, <0.27, 0.24, -0.24>, 0.018 }
      cylinder { <-0.27, 0, 0.26>, <-0.27, 0.24, 0.26>, 0.018 }
      cylinder { <0.27, 0, 0.26>, <0.27, 0.24, 0.26>, 0.018 }
      Skin(T_Black)
    }
    rotate y * 38 translate <1.15, 0, 3.55> }
  object {
    box { <0, 0, 0>, <1, 1, 1>
      #if (Colour) texture { Picture("rug.png") finish { diffuse 0.85 } } #end
      scale <1.7, 1.15, 0.012> rotate x * 90 translate <-0.85, 0.012, -0.575> rotate y * -7 }
    translate <0.25, 0, 2.25>
  }
  union {
    cone { <0, 0, 0>, 0.06, <0, 0.12, 0>, 0.085 Skin(Glossy(<0.62, 0.30, 0.18>, 0.1)) }
    cylinder { <0, 0.05, 0>, <0, 0.121, 0>, 0.078 Skin(T_Soil) }
    object { Plant(5, 0.30, 0.18, 7, 12) translate y * 0.11 }
    translate <W - 0.16, 0.73, 1.95>
  }
  object { Round(<0.52, 1.02, D - 0.009>, <0.60, 1.10, D>, 0.003) Skin(T_Trim) }
}

#include "end.inc"
