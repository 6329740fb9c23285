// A furnished living room with what defeats stereo: plain walls, a flush door, a
// plain cabinet, a plain table top, a floor with only a faint grain; and textured
// things between them.
#version 3.7;
#include "begin.inc"
#include "furniture.inc"

#declare W = 2.5;    // walls at x = -W and x = W
#declare D = 4.6;    // back wall at z = D
#declare H = 2.6;    // ceiling

#if (Colour)
  // A wide window behind the cameras, to the right.
  light_source {
    <1.9, 1.55, -0.55> rgb <0.60, 0.63, 0.68> * 1.55
    area_light <1.0, 0, 0.5>, <0, 1.3, 0>, 6, 6 adaptive 1
    fade_distance 3.0 fade_power 1.2
  }
  // A round ceiling lamp.
  light_source {
    <0.15, H - 0.10, 2.2> rgb <0.62, 0.54, 0.43> * 0.55
    area_light <0.6, 0, 0>, <0, 0, 0.6>, 6, 6 adaptive 1 circular
    fade_distance 2.0 fade_power 1.5
  }
#end

#declare T_BackWall = Flat(<0.80, 0.77, 0.70>)
#declare T_LeftWall = Flat(<0.60, 0.68, 0.66>)
#declare T_Ceiling = Flat(<0.85, 0.85, 0.83>)
#declare T_Trim = Glossy(<0.82, 0.81, 0.78>, 0.10)
#declare T_Door = Glossy(<0.74, 0.73, 0.70>, 0.06)
#declare T_Cabinet = Glossy(<0.72, 0.70, 0.66>, 0.08)
#declare T_Dark = Glossy(<0.06, 0.05, 0.05>, 0.2)
#declare T_TableTop = texture {
  pigment { rgb <0.46, 0.33, 0.22> }
  finish { diffuse 0.8 specular 0.12 roughness 0.05 }
}
// Boards so even that only a trace of grain is left.
#declare P_Grain = pigment {
  bozo turbulence 0.3 octaves 4 lambda 2.4 scale <0.9, 0.2, 0.035>
  color_map {
    [0.0 rgb <0.430, 0.352, 0.272>]
    [0.5 rgb <0.437, 0.359, 0.278>]
    [1.0 rgb <0.445, 0.366, 0.284>]
  }
}
#declare T_Floor = texture {
  pigment { P_Grain }
  finish { diffuse 0.85 specular 0.05 roughness 0.08 }
}
#declare T_Tweed = texture {
  // Aslant, so that no face of a cushion is parallel to the projection.
  Picture("tweed.png") scale 0.8 rotate <38, 0, 0> rotate <0, 43, 0>
}
#declare T_Chair = texture {
  Picture("chair.png") scale 0.42 rotate <33, 0, 0> rotate <0, 40, 0>
}
#declare T_Wicker = texture {
  pigment {
    radial frequency 46
    pigment_map {
      [0.5 gradient y scale 0.028
        color_map { [0.0 rgb <0.20, 0.11, 0.05>] [0.5 rgb <0.58, 0.40, 0.21>]
                    [1.0 rgb <0.20, 0.11, 0.05>] }]
      [0.5 gradient y scale 0.028 translate y * 0.014
        color_map { [0.0 rgb <0.20, 0.11, 0.05>] [0.5 rgb <0.66, 0.46, 0.25>]
                    [1.0 rgb <0.20, 0.11, 0.05>] }]
    }
  }
}
#declare T_Kraft = texture {
  pigment {
    granite scale <0.5, 0.04, 0.5>
    color_map { [0 rgb <0.20, 0.26, 0.30>] [1 rgb <0.46, 0.54, 0.56>] }
  }
}
#declare T_Granite = texture {
  pigment {
    granite scale 0.22 turbulence 0.2
    color_map {
      [0.0 rgb <0.10, 0.16, 0.22>]
      [0.4 rgb <0.20, 0.34, 0.42>]
      [0.6 rgb <0.62, 0.62, 0.52>]
      [1.0 rgb <0.85, 0.78, 0.62>]
    }
  }
  finish { diffuse 0.8 specular 0.7 roughness 0.01 reflection { 0.02, 0.12 fresnel on } }
}

// ---------------------------------------------------------------------------
// The room

#declare Shell = union {
  plane { z, D Skin(T_BackWall) }
  plane { x, -W Skin(T_LeftWall) }
  plane { x, W Skin(T_BackWall) }
  plane { z, -1.6 Skin(T_BackWall) }
  plane { y, H Skin(T_Ceiling) }
  plane { y, 0 Skin(T_Floor) }
  // Skirting.
  box { <-W, 0, D - 0.015>, <1.16, 0.09, D> Skin(T_Trim) }
  box { <2.14, 0, D - 0.015>, <W, 0.09, D> Skin(T_Trim) }
  box { <-W, 0, -1.6>, <-W + 0.015, 0.09, D> Skin(T_Trim) }
  box { <W - 0.015, 0, -1.6>, <W, 0.09, D> Skin(T_Trim) }
}

#declare Door = union {
  // Frame, leaf, handle, hinges. The leaf is flush and plain.
  box { <1.16, 0, D - 0.03>, <1.24, 2.12, D> Skin(T_Trim) }
  box { <2.06, 0, D - 0.03>, <2.14, 2.12, D> Skin(T_Trim) }
  box { <1.16, 2.04, D - 0.0305>, <2.14, 2.12, D> Skin(T_Trim) }
  box { <1.243, 0.005, D - 0.018>, <2.057, 2.037, D> Skin(T_Door) }
  union {
    cylinder { <1.32, 1.02, D - 0.018>, <1.32, 1.02, D - 0.026>, 0.027 }
    cylinder { <1.32, 1.02, D - 0.020>, <1.32, 1.02, D - 0.065>, 0.009 }
    cylinder { <1.32, 1.02, D - 0.065>, <1.44, 1.02, D - 0.065>, 0.010 }
    sphere { <1.32, 1.02, D - 0.065>, 0.010 }
    sphere { <1.44, 1.02, D - 0.065>, 0.010 }
    cylinder { <1.32, 0.93, D - 0.018>, <1.32, 0.93, D - 0.022>, 0.022 }
    cylinder { <2.058, 1.75, D - 0.034>, <2.058, 1.85, D - 0.034>, 0.008 }
    cylinder { <2.058, 0.25, D - 0.034>, <2.058, 0.35, D - 0.034>, 0.008 }
    Skin(T_Metal)
  }
}

#declare Bookshelf = union {
  #local X0 = -2.32; #local X1 = -1.12; #local Z0 = D - 0.31;
  union {
    box { <X0, 0, Z0>, <X0 + 0.025, 1.98, D - 0.001> }
    box { <X1 - 0.025, 0, Z0>, <X1, 1.98, D - 0.001> }
    #local I = 0;
    #while (I < 6)
      box { <X0 + 0.02, 0.07 + 0.377 * I, Z0 + 0.002>,
            <X1 - 0.02, 0.095 + 0.377 * I, D - 0.001> }
      #local I = I + 1;
    #end
    box { <X0, 0, D - 0.012>, <X1, 1.98, D - 0.001> }
    box { <X0 + 0.02, 0, Z0 + 0.03>, <X1 - 0.02, 0.08, Z0 + 0.04> }
    Skin(texture { T_Wood rotate y * 90 })
  }
  #local I = 0;
  #while (I < 5)
    union {
      #switch (I)
        #case (1) ShelfOfBooks(X0 + 0.03, X1 - 0.36, 0.30) #break
        #case (3) ShelfOfBooks(X0 + 0.26, X1 - 0.03, 0.29) #break
        #else ShelfOfBooks(X0 + 0.03, X1 - 0.03, 0.31)
      #end
      translate <0, 0.095 + 0.377 * I, Z0 + 0.025>
    }
    #local I = I + 1;
  #end
  // A jar and a box of files in the gaps.
  lathe {
    cubic_spline 7
    <0.05, -0.02>, <0.055, 0>, <0.085, 0.10>, <0.06, 0.19>, <0.045, 0.22>, <0.055, 0.24>,
    <0.06, 0.26>
    sturm
    translate <X0 + 0.14, 0.095 + 0.377 * 3, Z0 + 0.13>
    Skin(texture { T_Granite scale 0.5 })
  }
  box {
    <X1 - 0.33, 0.472, Z0 + 0.03>, <X1 - 0.06, 0.472 + 0.24, Z0 + 0.26>
    Skin(T_Kraft)
  }
}

#declare Sofa = union {
  // Its front to -z, the middle of its back at the origin; 1.9 m wide.
  object { Round(<-0.80, 0.12, -0.86>, <0.80, 0.30, -0.02>, 0.03) }
  object { Round(<-0.95, 0.10, -0.88>, <-0.79, 0.60, -0.02>, 0.06) }
  object { Round(<0.79, 0.10, -0.88>, <0.95, 0.60, -0.02>, 0.06) }
  object { Round(<-0.80, 0.25, -0.22>, <0.80, 0.82, -0.02>, 0.07) }
  object { Round(<-0.785, 0.29, -0.90>, <-0.003, 0.45, -0.20>, 0.05) }
  object { Round(<0.003, 0.29, -0.90>, <0.785, 0.45, -0.20>, 0.05) }
  object { Round(<-0.775, 0, -0.17>, <-0.005, 0.42, 0>, 0.06)
           rotate x * 11 translate <0, 0.44, -0.24> }
  object { Round(<0.005, 0, -0.17>, <0.775, 0.42, 0>, 0.06)
           rotate x * 11 translate <0, 0.44, -0.24> }
  Skin(T_Tweed)
}

#macro ThrowPillow(File, Size, Tilt, Turn, Roll, Where)
  object {
    Cushion(Size, 0.17)
    #if (Colour)
      texture { Picture(File) scale 0.5 translate <-0.25, -0.25, 0> }
    #end
    rotate z * Roll rotate x * Tilt rotate y * Turn translate Where
  }
#end

#declare Sideboard = union {
  // Along the left wall: x is its depth. Three plain doors.
  box { <-W, 0.10, 2.05>, <-W + 0.425, 0.74, 3.75> Skin(T_Cabinet) }
  object { Round(<-W, 0.74, 2.03>, <-W + 0.455, 0.765, 3.77>, 0.004) Skin(T_Cabinet) }
  #local I = 0;
  #while (I < 3)
    object {
      Round(<-W + 0.40, 0.12, 2.06 + 0.562 * I>, <-W + 0.443, 0.735, 2.616 + 0.562 * I>,
            0.003)
      Skin(T_Cabinet)
    }
    cylinder { <-W + 0.443, 0.66, 2.34 + 0.562 * I>, <-W + 0.463, 0.66, 2.34 + 0.562 * I>,
               0.013 Skin(T_Metal) }
    #local I = I + 1;
  #end
  box { <-W + 0.05, 0, 2.15>, <-W + 0.36, 0.10, 3.65> Skin(T_Dark) }
}

#declare Lamp = union {
  cylinder { <0, 0, 0>, <0, 0.02, 0>, 0.085 Skin(T_Metal) }
  sphere { <0, 0.13, 0>, 0.11 Skin(texture { T_Granite scale 0.6 }) }
  cylinder { <0, 0.2, 0>, <0, 0.32, 0>, 0.012 Skin(T_Metal) }
  cone { <0, 0.29, 0>, 0.17, <0, 0.52, 0>, 0.11 open Skin(Flat(<0.82, 0.76, 0.62>)) }
}

#declare Vase = lathe {
  cubic_spline 8
  <0.04, -0.03>, <0.06, 0>, <0.105, 0.11>, <0.085, 0.22>, <0.042, 0.29>, <0.058, 0.34>,
  <0.050, 0.335>, <0.035, 0.29>
  sturm
  Skin(T_Granite)
}

#declare Table = union {
  // A plain top on four legs; its middle over the origin.
  object { Round(<-0.62, 0.39, -0.34>, <0.62, 0.42, 0.34>, 0.008) Skin(T_TableTop) }
  #local I = 0;
  #while (I < 4)
    #local X = (mod(I, 2) = 0 ? -0.55 : 0.51);
    #local Z = (I < 2 ? -0.27 : 0.23);
    box { <X, 0, Z>, <X + 0.04, 0.395, Z + 0.04> Skin(texture { T_Wood rotate x * 90 }) }
    #local I = I + 1;
  #end
}

#declare Bowl = union {
  difference {
    sphere { <0, 0.13, 0>, 0.13 }
    sphere { <0, 0.13, 0>, 0.122 }
    plane { -y, -0.10 }
    scale <1.15, 0.9, 1.15>
    Skin(Glossy(<0.75, 0.74, 0.70>, 0.6))
  }
  #local R = seed(3);
  #local I = 0;
  #while (I < 7)
    #local A = 360 * I / 6;
    sphere {
      (I < 6 ? <0.074 * cos(radians(A)), 0.090, 0.074 * sin(radians(A))> : <0, 0.135, 0>),
      0.038 + 0.003 * rand(R)
      #if (Colour)
        texture {
          pigment {
            bozo turbulence 0.6 scale <0.012, 0.03, 0.012>
            #if (mod(I, 2))
              color_map { [0.2 rgb <0.52, 0.06, 0.03>] [0.5 rgb <0.66, 0.16, 0.04>]
                          [0.8 rgb <0.70, 0.50, 0.12>] }
            #else
              color_map { [0.2 rgb <0.75, 0.30, 0.03>] [0.8 rgb <0.82, 0.42, 0.06>] }
            #end
          }
          normal { bumps 0.2 scale 0.004 }
          finish { diffuse 0.8 specular 0.4 roughness 0.02 }
        }
      #end
    }
    #local I = I + 1;
  #end
}

#declare Mug = union {
  difference {
    cylinder { <0, 0, 0>, <0, 0.10, 0>, 0.042 }
    cylinder { <0, 0.006, 0>, <0, 0.11, 0>, 0.037 }
  }
  torus { 0.026, 0.006 rotate x * 90 translate <0.052, 0.052, 0> }
  Skin(Glossy(<0.16, 0.27, 0.36>, 0.7))
}

#macro Paper(File, Thick)
  box {
    <0, 0, 0>, <1, 1, 1>
    #if (Colour) texture { Picture(File) finish { specular 0.15 roughness 0.03 } } #end
    scale <0.21, 0.28, Thick> translate <-0.105, -0.14, -Thick> rotate x * 90
  }
#end

#declare Armchair = union {
  // Its front to -z, the middle of the seat over the origin.
  object { Round(<-0.30, 0.22, -0.32>, <0.30, 0.44, 0.28>, 0.05) }
  object { Round(<-0.36, 0.18, -0.30>, <-0.27, 0.62, 0.34>, 0.04) }
  object { Round(<0.27, 0.18, -0.30>, <0.36, 0.62, 0.34>, 0.04) }
  object { Round(<-0.34, 0, -0.07>, <0.34, 0.62, 0.07>, 0.06)
           rotate x * 14 translate <0, 0.34, 0.30> }
  Skin(T_Chair)
}
#declare ChairLegs = union {
  #local I = 0;
  #while (I < 4)
    #local X = (mod(I, 2) = 0 ? -0.28 : 0.28);
    #local Z = (I < 2 ? -0.24 : 0.28);
    cone { <X * 1.12, 0, Z * 1.12>, 0.014, <X, 0.24, Z>, 0.024 }
    #local I = I + 1;
  #end
  Skin(texture { T_Wood rotate x * 90 })
}

#declare Basket = union {
  difference {
    cone { <0, 0, 0>, 0.15, <0, 0.30, 0>, 0.19 }
    cone { <0, 0.26, 0>, 0.165, <0, 0.31, 0>, 0.175 }
    Skin(T_Wicker)
  }
  torus { 0.187, 0.012 translate y * 0.30 Skin(T_Wicker) }
  cylinder { <0, 0.2, 0>, <0, 0.265, 0>, 0.167 Skin(T_Soil) }
}

#declare Everything = union {
  object { Shell }
  object { Door }
  object { Bookshelf }
  object { Sideboard }
  // The back wall.
  object { Sofa translate <0.02, 0, D - 0.06> }
  ThrowPillow("kilim.png", 0.44, 20, 22, 4, <-0.62, 0.66, D - 0.54>)
  ThrowPillow("leafy.png", 0.46, 18, -12, -5, <0.50, 0.67, D - 0.55>)
  ThrowPillow("kilim.png", 0.38, 28, -34, 12, <0.70, 0.61, D - 0.66>)
  object { Framed("landscape.png", 1.05, 0.68, 0.035, texture { T_Wood rotate y * 90 })
           translate <0.02, 1.52, D> }
  object { Round(<1.02, 1.06, D - 0.009>, <1.10, 1.14, D>, 0.003) Skin(T_Trim) }
  // The left wall.
  object { Framed("print_a.png", 0.42, 0.56, 0.022, T_Dark) rotate y * -90
           translate <-W, 1.56, 3.22> }
  object { Framed("print_b.png", 0.42, 0.56, 0.022, T_Dark) rotate y * -90
           translate <-W, 1.56, 2.62> }
  object { Lamp translate <-W + 0.22, 0.765, 3.52> }
  object { Vase translate <-W + 0.22, 0.765, 2.95> }
  object { Paper("magazine_b.png", 0.012) rotate y * 78 translate <-W + 0.25, 0.765, 2.52> }
  object { Paper("magazine_a.png", 0.010) rotate y * 95 translate <-W + 0.25, 0.777, 2.52> }
  // The middle.
  object {
    box { <0, 0, 0>, <1, 1, 1>
      #if (Colour) texture { Picture("rug.png") finish { diffuse 0.85 } } #end
      scale <2.4, 1.7, 0.012> rotate x * 90 translate <-1.2, 0.012, -0.85> rotate y * 3 }
    translate <-0.28, 0, 2.75>
  }
  object { Table rotate y * 4 translate <-0.30, 0.012, 2.80> }
  object { Bowl translate <-0.62, 0.432, 2.86> }
  object { Mug rotate y * 215 translate <0.10, 0.432, 2.62> }
  object { Paper("magazine_a.png", 0.008) rotate y * -24 translate <-0.20, 0.432, 2.92> }
  object { Paper("magazine_b.png", 0.006) rotate y * 11 translate <-0.18, 0.440, 2.93> }
  union { object { Armchair } object { ChairLegs } rotate y * 52
          translate <1.45, 0, 3.05> }
  object { Basket translate <1.02, 0, 4.22> }
  object { Plant(6, 1.05, 0.36, 10, 11) translate <1.02, 0.26, 4.22> }
}

#include "end.inc"
