// A corridor: plain walls, flush doors, a linoleum floor that reflects the window at the
// right. A notice board, a runner, a bench with a cushion, a plant at the end.
#version 3.7;
#include "begin.inc"
#include "furniture.inc"

#declare W = 0.95;   // walls at x = -W and x = W
#declare D = 6.2;    // end wall at z = D
#declare H = 2.55;   // ceiling
#declare Out = 2.7;  // the house across the yard at x = Out

#declare T_Wall = Flat(<0.77, 0.76, 0.72>)
#declare T_EndWall = Flat(<0.70, 0.73, 0.68>)
#declare T_Ceiling = Flat(<0.84, 0.84, 0.83>)
#declare T_Door = Glossy(<0.70, 0.72, 0.73>, 0.10)
#declare T_Frame = Glossy(<0.36, 0.38, 0.40>, 0.10)
#declare T_White = Glossy(<0.82, 0.82, 0.80>, 0.15)
#declare T_Red = Glossy(<0.60, 0.04, 0.03>, 0.6)
#declare T_Black = Glossy(<0.04, 0.04, 0.04>, 0.2)
#declare T_Lino = texture {
  pigment {
    bozo turbulence 0.4 octaves 3 scale 0.03
    color_map { [0.2 rgb <0.235, 0.262, 0.250>] [0.8 rgb <0.262, 0.290, 0.275>] }
  }
  finish { diffuse 0.8 specular 0.2 roughness 0.02 reflection { 0.02, 0.35 falloff 3 } }
}
#declare T_Cork = texture {
  pigment {
    granite scale 0.08
    color_map { [0 rgb <0.24, 0.14, 0.07>] [0.5 rgb <0.50, 0.33, 0.18>] [1 rgb <0.66, 0.47, 0.28>] }
  }
}

#if (Colour)
  // Daylight in the window, and two ceiling panels, of which the farther is dim.
  light_source {
    <W + 0.11, 1.60, 2.95> rgb <0.62, 0.70, 0.80> * 0.85
    area_light <0, 1.0, 0>, <0, 0, 1.1>, 7, 7 adaptive 1
    fade_distance 1.5 fade_power 2
  }
  light_source {
    <0, H - 0.06, 0.6> rgb <0.72, 0.70, 0.64> * 0.42
    area_light <0.3, 0, 0>, <0, 0, 1.1>, 3, 5 adaptive 1
    fade_distance 2 fade_power 1.5
  }
  light_source {
    <0, H - 0.06, 4.6> rgb <0.72, 0.68, 0.58> * 0.30
    area_light <0.3, 0, 0>, <0, 0, 1.1>, 3, 5 adaptive 1
    fade_distance 2 fade_power 1.5
  }
  light_source { <0, 1.7, -1.5> rgb 0.035 shadowless }
#end

#declare Shell = union {
  plane { x, -W Skin(T_Wall) }
  plane { z, D Skin(T_EndWall) }
  plane { z, -3 Skin(T_EndWall) }
  plane { y, H Skin(T_Ceiling) }
  plane { y, 0 Skin(T_Lino) }
  // The right wall, with the niche of the window.
  difference {
    box { <W, -0.1, -3.1>, <W + 0.28, H + 0.1, D + 0.1> }
    box { <W - 0.1, 0.95, 2.30>, <W + 0.4, 2.15, 3.60> }
    Skin(T_Wall)
  }
  // Skirting.
  union {
    box { <-W, 0, -3>, <-W + 0.012, 0.08, 0.94> }
    box { <-W, 0, 2.06>, <-W + 0.012, 0.08, D> }
    box { <W - 0.012, 0, -3>, <W, 0.08, 4.14> }
    box { <W - 0.012, 0, 5.26>, <W, 0.08, D> }
    Skin(T_Frame)
  }
  // Panels of light.
  #local I = 0;
  #while (I < 2)
    box {
      <-0.18, H - 0.045, -0.55 + 4 * I>, <0.18, H, 0.75 + 4 * I>
      Skin(texture { pigment { rgb <0.9, 0.88, 0.82> } finish { diffuse 0.3 emission (I = 0 ? 1.1 : 0.8) } })
      translate z * 0.5
    }
    #local I = I + 1;
  #end
}

#declare Window = union {
  // Frame and mullion in the niche; the sill.
  union {
    box { <W + 0.16, 0.95, 2.30>, <W + 0.22, 1.01, 3.60> }
    box { <W + 0.16, 2.09, 2.30>, <W + 0.22, 2.15, 3.60> }
    box { <W + 0.16, 0.95, 2.30>, <W + 0.22, 2.15, 2.36> }
    box { <W + 0.16, 0.95, 3.54>, <W + 0.22, 2.15, 3.60> }
    box { <W + 0.16, 0.95, 2.92>, <W + 0.22, 2.15, 2.98> }
    box { <W - 0.05, 0.925, 2.26>, <W + 0.20, 0.955, 3.64> }
    Skin(T_White)
  }
  #if (Colour)
    // The pane is not in the depth, which is that of the house across.
    box {
      <W + 0.188, 0.95, 2.30>, <W + 0.192, 2.15, 3.60> no_shadow
      texture { pigment { rgbt <1, 1, 1, 1> } finish { diffuse 0 reflection 0.05 } }
    }
  #end
  // The house across the yard: plaster and bricks in an overcast light.
  plane {
    x, Out
    Skin(texture {
      pigment {
        brick pigment { rgb <0.62, 0.60, 0.56> },
              pigment { granite scale 0.4 color_map { [0 rgb <0.34, 0.15, 0.11>] [1 rgb <0.62, 0.32, 0.22>] } }
        brick_size <0.25, 0.08, 0.12> mortar 0.012 rotate y * 90
      }
      finish { diffuse 0 emission 1.5 }
    })
  }
  // A pot on the sill.
  union {
    cone { <0, 0, 0>, 0.055, <0, 0.10, 0>, 0.075 Skin(Glossy(<0.55, 0.24, 0.13>, 0.1)) }
    cylinder { <0, 0.05, 0>, <0, 0.101, 0>, 0.068 Skin(T_Soil) }
    object { Plant(4, 0.22, 0.16, 6, 21) translate y * 0.10 }
    translate <W + 0.05, 0.955, 3.32>
  }
}

#declare Radiator = union {
  #local I = 0;
  #while (I < 22)
    object { Round(<W - 0.10, 0.16, 2.42 + 0.05 * I>, <W - 0.04, 0.76, 2.455 + 0.05 * I>, 0.014) }
    #local I = I + 1;
  #end
  box { <W - 0.09, 0.20, 2.43>, <W - 0.05, 0.24, 3.50> }
  box { <W - 0.09, 0.68, 2.43>, <W - 0.05, 0.72, 3.50> }
  cylinder { <W - 0.07, 0, 2.37>, <W - 0.07, 0.22, 2.37>, 0.011 }
  cylinder { <W - 0.07, 0.22, 2.37>, <W - 0.07, 0.22, 2.43>, 0.011 }
  Skin(T_White)
}

// On a wall that faces -z.
#declare Board = union {
  box { <-0.65, -0.45, -0.015>, <0.65, 0.45, 0> Skin(T_Cork) }
  difference {
    box { <-0.68, -0.48, -0.025>, <0.68, 0.48, 0> }
    box { <-0.65, -0.45, -1>, <0.65, 0.45, 1> }
    Skin(T_Metal)
  }
  object { Sheet("page_a.png", 0.21, 0.30) rotate z * 2 translate <-0.48, 0.22, -0.016> }
  object { Sheet("page_b.png", 0.21, 0.30) rotate z * -3 translate <-0.20, 0.18, -0.017> }
  object { Sheet("page_c.png", 0.30, 0.42) rotate z * 1 translate <0.42, 0.10, -0.016> }
  object { Sheet("page_a.png", 0.15, 0.21) rotate z * -6 translate <0.10, 0.26, -0.018> }
  object { Sheet("page_d.png", 0.21, 0.30) rotate z * 4 translate <-0.38, -0.20, -0.018> }
  object { Sheet("postcard.png", 0.15, 0.10) rotate z * -4 translate <-0.02, -0.10, -0.016> }
  object { Sheet("postcard.png", 0.12, 0.09) rotate z * 7 translate <0.08, -0.28, -0.016> }
}

#declare Extinguisher = union {
  cylinder { <0, 0.06, 0>, <0, 0.42, 0>, 0.075 Skin(T_Red) }
  sphere { <0, 0.42, 0>, 0.075 Skin(T_Red) }
  cylinder { <0, 0.0, 0>, <0, 0.06, 0>, 0.070 Skin(T_Black) }
  cylinder { <0, 0.48, 0>, <0, 0.55, 0>, 0.02 Skin(T_Metal) }
  box { <-0.015, 0.54, -0.10>, <0.015, 0.57, 0.02> Skin(T_Black) }
  cylinder { <0, 0.52, 0>, <0.09, 0.30, -0.03>, 0.010 Skin(T_Black) }
  object { Sheet("page_b.png", 0.10, 0.14) translate <0, 0.26, -0.0755> }
}

#declare Bench = union {
  // Along the left wall; its front to -z.
  object { Round(<-0.50, 0.40, -0.36>, <0.50, 0.44, -0.02>, 0.008) Skin(texture { T_Wood rotate y * 90 }) }
  box { <-0.46, 0, -0.34>, <-0.42, 0.40, -0.30> Skin(T_Black) }
  box { <0.42, 0, -0.34>, <0.46, 0.40, -0.30> Skin(T_Black) }
  box { <-0.46, 0, -0.08>, <-0.42, 0.40, -0.04> Skin(T_Black) }
  box { <0.42, 0, -0.08>, <0.46, 0.40, -0.04> Skin(T_Black) }
  object {
    Cushion(0.40, 0.14)
    #if (Colour) texture { Picture("kilim.png") scale 0.5 translate <-0.25, -0.25, 0> } #end
    rotate x * 16 translate <0.22, 0.63, -0.14>
  }
  union { ShelfOfBooks(-0.42, -0.20, 0.24) translate <0, 0.44, -0.26> }
}

#declare Everything = union {
  object { Shell }
  object { Window }
  object { Radiator }
  object { DoorOf(0.94, 2.05, -1, T_Door, T_Frame) rotate y * -90 translate <-W, 0, 1.50> }
  object { DoorOf(0.94, 2.05, 1, T_Door, T_Frame) rotate y * 90 translate <W, 0, 4.70> }
  object { DoorOf(0.94, 2.05, -1, T_Door, T_Frame) translate <-0.20, 0, D> }
  object { Sheet("page_d.png", 0.15, 0.10) rotate y * -90 translate <-W, 1.60, 2.20> }
  object { Sheet("page_a.png", 0.15, 0.10) rotate y * 90 translate <W, 1.60, 4.02> }
  object { Board rotate y * -90 translate <-W, 1.52, 3.10> }
  object { Bench rotate y * -90 translate <-W, 0, 4.40> }
  object { Framed("print_a.png", 0.42, 0.56, 0.022, T_Black) rotate y * -90 translate <-W, 1.56, 4.55> }
  object { Extinguisher translate <0.72, 0.10, D - 0.10> }
  object { Sheet("sign.png", 0.15, 0.15) translate <0.72, 1.30, D> }
  // Switches beside the near door and at the end.
  object { Round(<-W, 1.05, 0.78>, <-W + 0.010, 1.13, 0.86>, 0.003) Skin(T_White) }
  object { Round(<0.42, 1.05, D - 0.010>, <0.50, 1.13, D>, 0.003) Skin(T_White) }
  object {
    box { <0, 0, 0>, <1, 1, 1>
      #if (Colour) texture { Picture("runner.png") finish { diffuse 0.85 } } #end
      scale <2.6, 0.75, 0.008> rotate x * 90 translate <-1.3, 0.008, -0.375> rotate y * 91 }
    translate <-0.10, 0, 2.85>
  }
  union {
    cone { <0, 0, 0>, 0.12, <0, 0.26, 0>, 0.155 Skin(Glossy(<0.75, 0.74, 0.70>, 0.4)) }
    cylinder { <0, 0.2, 0>, <0, 0.261, 0>, 0.145 Skin(T_Soil) }
    object { Plant(5, 0.95, 0.30, 9, 5) translate y * 0.25 }
    translate <-0.72, 0, 5.80>
  }
}

#include "end.inc"
