"""What scripts/convert_maps is made of: maps of a workspace for other programs, and back.

    convert_maps.py  the program
    exporting.py     all views of a workspace into a folder
    sources.py       files of any program as depth and normals of views
    importing.py     these into the maps of a workspace
    formats.py       numbers and normals per pixel in EXR, PFM, 16-bit PNG and NPY
    exr_channels.py  what a channel of an EXR file is called
    layout.py        names of files, and the text beside them that says what they mean
    confidences.py   how many views confirm each pixel of a view
    slopes.py        normals from nothing but depth
"""
