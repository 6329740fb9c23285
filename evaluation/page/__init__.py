"""What scripts/result_page is made of: one HTML file that shows a dense workspace.

It opens without a network: pictures and points are in it, and so is three.js, which draws
the points. The same viewer stands in the report.html of scripts/evaluate.

    result_page.py  the program: gathers all parts of a page
    workspace.py    photographs of a workspace, its options and files
    left_out.py     photographs that did not make it, and why
    logs.py         times and warnings from what programs printed
    maps.py         pictures of one photograph's maps
    confidence.py   how many views confirm what a photograph sees
    scene.py        points and cameras for the viewer
    thinning.py     fewer points, spread evenly
    html.py         templates/ and three.js become a page
    report_page.py  the report of scripts/evaluate as a page
    browser.py      a picture of a page, as a browser without a screen shows it
"""
