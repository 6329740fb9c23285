"""What renders a scene: photographs, exact depth, and a sparse model of the photographs.

scene.py describes a scene; povray.py renders light and depth; camera.py has poses and
turns light into a photograph; sparse_model.py makes the model from photographs;
pictures.py draws what is printed or woven on things. begin.inc, furniture.inc and
end.inc are what scenes share in POV-Ray's language.
"""
