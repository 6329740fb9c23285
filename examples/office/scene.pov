// An office: white desks that reflect a little, monitors like black glass, a whiteboard,
// plain walls, a carpet of one colour. Paper, books, a plant, mugs and chairs.
#version 3.7;
#include "begin.inc"
#include "furniture.inc"

#declare W = 2.6;    // walls at x = -W and x = W
#declare D = 4.4;    // back wall at z = D
#declare H = 2.7;    // ceiling

#declare T_Wall = Flat(<0.80, 0.80, 0.79>)
#declare T_Accent = Flat(<0.42, 0.52, 0.56>)
#declare T_Ceiling = Flat(<0.86, 0.86, 0.86>)
#declare T_Trim = Glossy(<0.70, 0.70, 0.70>, 0.10)
#declare T_Desk = texture {
  pigment { rgb <0.83, 0.83, 0.81> }
  finish { diffuse 0.8 specular 0.25 roughness 0.02 reflection { 0.03, 0.30 falloff 4 } }
}
#declare T_Cabinet = Glossy(<0.79, 0.79, 0.78>, 0.12)
#declare T_Steel = Glossy(<0.34, 0.35, 0.36>, 0.4)
#declare T_Black = Glossy(<0.035, 0.035, 0.04>, 0.25)
#declare T_Glass = texture {
  pigment { rgb <0.012, 0.012, 0.014> }
  finish { diffuse 0.6 specular 0.5 roughness 0.004 reflection { 0.05, 0.35 falloff 3 } }
}
#declare T_Carpet = texture {
  pigment {
    granite scale 0.02
    color_map { [0 rgb <0.135, 0.145, 0.165>] [1 rgb <0.195, 0.205, 0.225>] }
  }
}
#declare T_Seat = texture {
  Picture("tweed.png") scale 0.5 rotate <35, 0, 0> rotate <0, 40, 0>
}

#if (Colour)
  // Two ceiling panels, and the sky in the window at the right.
  #local I = 0;
  #while (I < 2)
    light_source {
      <-1.1 + 2.2 * I, H - 0.05, 1.6> rgb <0.74, 0.76, 0.76> * 0.50
      area_light <0.6, 0, 0>, <0, 0, 1.2>, 3, 5 adaptive 1
      fade_distance 2.5 fade_power 1.5
    }
    #local I = I + 1;
  #end
  light_source {
    <W - 0.12, 1.65, 1.6> rgb <0.62, 0.68, 0.78> * 0.75
    area_light <0, 1.0, 0>, <0, 0, 1.6>, 4, 5 adaptive 1
    fade_distance 2 fade_power 1.6
  }
  light_source { <0, 1.6, -1.2> rgb 0.05 shadowless }
#end

#declare Shell = union {
  plane { z, D Skin(T_Wall) }
  plane { x, -W Skin(T_Accent) }
  plane { x, W Skin(T_Wall) }
  plane { z, -2.2 Skin(T_Wall) }
  plane { y, H Skin(T_Ceiling) }
  plane { y, 0 Skin(T_Carpet) }
  box { <-W, 0, D - 0.012>, <W, 0.07, D> Skin(T_Trim) }
  box { <-W, 0, -2.2>, <-W + 0.012, 0.07, D> Skin(T_Trim) }
  box { <W - 0.012, 0, -2.2>, <W, 0.07, D> Skin(T_Trim) }
  #local I = 0;
  #while (I < 2)
    box {
      <-1.4 + 2.2 * I, H - 0.03, 1.0>, <-0.8 + 2.2 * I, H, 2.2>
      Skin(texture { pigment { rgb 0.9 } finish { diffuse 0.3 emission 1.2 } })
    }
    #local I = I + 1;
  #end
}

// In the right wall, behind closed blinds.
#declare Window = union {
  #local I = 0;
  #while (I < 26)
    box {
      <-0.002, -0.024, 0.75>, <0.002, 0.024, 2.45>
      Skin(texture { pigment { rgb <0.80, 0.81, 0.82> } finish { diffuse 0.6 emission 0.38 } })
      rotate z * 18 translate <W - 0.05, 0.98 + 0.046 * I, 0>
    }
    #local I = I + 1;
  #end
  box { <W - 0.08, 2.16, 0.72>, <W, 2.22, 2.48> Skin(T_Trim) }
  box { <W - 0.16, 0.90, 0.70>, <W, 0.93, 2.50> Skin(T_Trim) }
  box { <W - 0.012, 0.93, 0.75>, <W, 2.16, 2.45> Skin(T_Trim) }
}

// The middle of its front edge at the origin, 0.74 high, user at -z.
#macro Desk(Wide)
  union {
    object { Round(<-Wide / 2, 0.715, 0>, <Wide / 2, 0.74, 0.80>, 0.003) Skin(T_Desk) }
    box { <-Wide / 2 + 0.04, 0, 0.05>, <-Wide / 2 + 0.08, 0.715, 0.09> Skin(T_Steel) }
    box { <-Wide / 2 + 0.04, 0, 0.71>, <-Wide / 2 + 0.08, 0.715, 0.75> Skin(T_Steel) }
    box { <Wide / 2 - 0.08, 0, 0.05>, <Wide / 2 - 0.04, 0.715, 0.09> Skin(T_Steel) }
    box { <Wide / 2 - 0.08, 0, 0.71>, <Wide / 2 - 0.04, 0.715, 0.75> Skin(T_Steel) }
    box { <-Wide / 2 + 0.10, 0.36, 0.74>, <Wide / 2 - 0.10, 0.70, 0.755> Skin(T_Cabinet) }
  }
#end

// Its foot at the origin, the screen to -z. On: it shows a picture.
#macro Monitor(On)
  union {
    object { Round(<-0.31, 0.12, -0.012>, <0.31, 0.49, 0.022>, 0.006) Skin(T_Black) }
    #if (On)
      box {
        <0, 0, 0>, <1, 1, 1>
        #if (Colour)
          texture { Picture("screen.png") finish { diffuse 0.1 emission 0.75 reflection 0.04 } }
        #end
        scale <0.596, 0.335, 0.002> translate <-0.298, 0.138, -0.0135>
      }
    #else
      box { <-0.298, 0.138, -0.0135>, <0.298, 0.473, 0> Skin(T_Glass) }
    #end
    box { <-0.03, 0.01, 0.03>, <0.03, 0.33, 0.045> Skin(T_Steel) }
    object { Round(<-0.12, 0, -0.06>, <0.12, 0.012, 0.11>, 0.004) Skin(T_Steel) }
  }
#end

#declare Keyboard = union {
  object { Round(<-0.22, 0, -0.07>, <0.22, 0.012, 0.07>, 0.004) Skin(T_Black) }
  #local J = 0;
  #while (J < 5)
    #local I = 0;
    #while (I < 16)
      box {
        <-0.21 + 0.0265 * I, 0.011, -0.062 + 0.025 * J>, <-0.188 + 0.0265 * I, 0.018, -0.041 + 0.025 * J>
        Skin(Flat(<0.16, 0.16, 0.17>))
      }
      #local I = I + 1;
    #end
    #local J = J + 1;
  #end
}

#declare Pedestal = union {
  box { <-0.20, 0.02, 0>, <0.20, 0.60, 0.55> Skin(T_Cabinet) }
  #local I = 0;
  #while (I < 3)
    object { Round(<-0.198, 0.03 + 0.19 * I, -0.018>, <0.198, 0.215 + 0.19 * I, 0.002>, 0.002) Skin(T_Cabinet) }
    box { <-0.06, 0.17 + 0.19 * I, -0.03>, <0.06, 0.18 + 0.19 * I, -0.018> Skin(T_Steel) }
    #local I = I + 1;
  #end
}

// The seat over the origin, its front to +z.
#declare Chair = union {
  object { Round(<-0.24, 0.44, -0.22>, <0.24, 0.51, 0.25>, 0.03) Skin(T_Seat) }
  object { Round(<-0.22, 0.62, -0.03>, <0.22, 1.05, 0.03>, 0.028) rotate x * -8 translate z * -0.16 Skin(T_Seat) }
  union {
    box { <-0.03, 0.42, -0.30>, <0.03, 0.72, -0.27> }
    box { <-0.03, 0.42, -0.29>, <0.03, 0.44, 0> }
    cylinder { <0, 0.10, 0>, <0, 0.44, 0>, 0.028 }
    #local I = 0;
    #while (I < 5)
      cylinder { <0, 0.10, 0>, vrotate(<0, 0.06, 0.29>, y * 72 * I), 0.018 }
      sphere { vrotate(<0, 0.032, 0.29>, y * 72 * I), 0.031 }
      #local I = I + 1;
    #end
    Skin(T_Black)
  }
}

#declare Mug = union {
  difference {
    cylinder { <0, 0, 0>, <0, 0.095, 0>, 0.041 }
    cylinder { <0, 0.006, 0>, <0, 0.11, 0>, 0.037 }
  }
  torus { 0.025, 0.006 rotate x * 90 translate <0.050, 0.050, 0> }
}

#macro Flatly(File, Wide, Tall, Thick, Turn)
  object { Sheet(File, Wide, Tall) scale <1, 1, Thick / 0.002> rotate x * 90 translate y * Thick rotate y * Turn
           translate y * 0.0005 }
#end

#declare Shelf = union {
  // Low and white, against the back wall; its front at z = 0.
  box { <-0.60, 0, 0>, <-0.58, 1.22, 0.36> Skin(T_Cabinet) }
  box { <0.58, 0, 0>, <0.60, 1.22, 0.36> Skin(T_Cabinet) }
  #local I = 0;
  #while (I < 4)
    box { <-0.60, 0.05 + 0.383 * I, 0>, <0.60, 0.07 + 0.383 * I, 0.36> Skin(T_Cabinet) }
    #local I = I + 1;
  #end
  box { <-0.60, 0.05, 0.35>, <0.60, 1.22, 0.36> Skin(T_Cabinet) }
  union { ShelfOfBooks(-0.57, 0.56, 0.32) translate <0, 0.453, 0.04> }
  union { ShelfOfBooks(-0.57, 0.10, 0.31) translate <0, 0.836, 0.04> }
  // Closed below.
  object { Round(<-0.598, 0.06, -0.018>, <-0.002, 0.44, 0>, 0.002) Skin(T_Cabinet) }
  object { Round(<0.002, 0.06, -0.018>, <0.598, 0.44, 0>, 0.002) Skin(T_Cabinet) }
}

#declare Whiteboard = union {
  box {
    <0, 0, 0>, <1, 1, 1>
    #if (Colour)
      texture {
        Picture("whiteboard.png")
        finish { diffuse 0.8 specular 0.3 roughness 0.01 reflection { 0.02, 0.25 falloff 4 } }
      }
    #end
    scale <1.6, 1.0, 0.012> translate <-0.8, -0.5, -0.012>
  }
  difference {
    box { <-0.82, -0.52, -0.02>, <0.82, 0.52, 0> }
    box { <-0.80, -0.50, -1>, <0.80, 0.50, 1> }
    Skin(T_Steel)
  }
  box { <-0.5, -0.54, -0.07>, <0.5, -0.52, 0> Skin(T_Steel) }
}

#declare Everything = union {
  object { Shell }
  object { Window }
  // Two desks in a row, a third one at the left wall.
  object { Desk(1.6) translate <-0.62, 0, 2.05> }
  object { Desk(1.6) translate <1.00, 0, 2.05> }
  object { Desk(1.4) rotate y * -90 translate <-W + 0.82, 0, 2.35> }
  object { Monitor(0) rotate y * 8 translate <-0.95, 0.7405, 2.50> }
  object { Monitor(1) rotate y * -9 translate <-0.28, 0.7405, 2.52> }
  object { Monitor(0) rotate y * -4 translate <1.05, 0.7405, 2.50> }
  object { Monitor(0) rotate y * -80 translate <-W + 0.38, 0.7405, 2.42> }
  object { Keyboard rotate y * 3 translate <-0.62, 0.7405, 2.22> }
  object { Keyboard rotate y * -6 translate <1.02, 0.7405, 2.24> }
  object { Round(<-0.03, 0, -0.05>, <0.03, 0.03, 0.05>, 0.014) translate <-0.30, 0.7405, 2.22> Skin(T_Black) }
  object { Mug rotate y * 160 translate <0.10, 0.7405, 2.32> Skin(Glossy(<0.62, 0.20, 0.12>, 0.6)) }
  object { Mug rotate y * 20 translate <1.55, 0.7405, 2.46> Skin(Glossy(<0.80, 0.80, 0.78>, 0.6)) }
  object { Flatly("page_a.png", 0.21, 0.30, 0.002, 14) translate <-1.22, 0.7405, 2.26> }
  object { Flatly("page_b.png", 0.21, 0.30, 0.004, -20) translate <0.45, 0.7405, 2.36> }
  object { Flatly("page_a.png", 0.21, 0.30, 0.002, 35) translate <0.52, 0.7450, 2.42> }
  object { Flatly("magazine.png", 0.21, 0.28, 0.012, -12) translate <1.52, 0.7405, 2.22> }
  object { Flatly("magazine.png", 0.21, 0.28, 0.006, 70) translate <-W + 0.50, 0.7405, 1.92> }
  union { ShelfOfBooks(0, 0.22, 0.26) translate <1.42, 0.7405, 2.62> }
  object { Pedestal translate <-1.15, 0, 2.12> }
  object { Pedestal translate <1.52, 0, 2.12> }
  object { Chair rotate y * 25 translate <-0.50, 0, 1.62> }
  object { Chair rotate y * -35 translate <1.10, 0, 1.55> }
  object { Shelf translate <1.60, 0, D - 0.37> }
  object { Whiteboard translate <-0.55, 1.62, D> }
  object { Framed("poster.png", 0.50, 0.70, 0.02, T_Black) translate <1.55, 1.85, D> }
  object { Framed("print.png", 0.40, 0.53, 0.02, T_Black) rotate y * -90 translate <-W, 1.65, 3.30> }
  union {
    cone { <0, 0, 0>, 0.13, <0, 0.30, 0>, 0.16 Skin(Glossy(<0.16, 0.17, 0.18>, 0.3)) }
    cylinder { <0, 0.2, 0>, <0, 0.301, 0>, 0.15 Skin(T_Soil) }
    object { Plant(6, 1.15, 0.38, 10, 31) translate y * 0.29 }
    translate <-W + 0.38, 0, D - 0.40>
  }
  union {
    cone { <0, 0, 0>, 0.06, <0, 0.11, 0>, 0.08 Skin(Glossy(<0.80, 0.79, 0.75>, 0.4)) }
    cylinder { <0, 0.05, 0>, <0, 0.111, 0>, 0.072 Skin(T_Soil) }
    object { Plant(4, 0.26, 0.18, 6, 8) translate y * 0.10 }
    translate <2.0, 1.22, D - 0.20>
  }
  // Cables in a duct, a socket.
  object { Round(<0.40, 0.30, D - 0.010>, <0.56, 0.38, D>, 0.003) Skin(T_Trim) }
}

#include "end.inc"
