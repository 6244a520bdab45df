# SPDX-License-Identifier: Apache-2.0
"""Every picture that materials name: which function makes it, whether it is data, its JPEG
quality."""
from . import landscapes, portraits, surfaces, textiles

# (function, (name, is data, quality) for each picture it returns)
RECIPES = [
    (surfaces.plaster, ('plaster', False, 85), ('plaster_normal', True, 82)),
    (surfaces.ashlar, ('ashlar', False, 86), ('ashlar_normal', True, 80)),
    (surfaces.smooth_stone, ('smooth_stone', False, 85)),
    (surfaces.marble_floor, ('floor', False, 86), ('floor_packed', True, 80)),
    (surfaces.oak, ('oak', False, 86), ('oak_normal', True, 84), ('oak_packed', True, 80)),
    (surfaces.dark_oak, ('dark_oak', False, 85)),
    (surfaces.cobbles, ('cobbles', False, 85), ('cobbles_normal', True, 82)),
    (surfaces.shingles, ('shingles', False, 85), ('shingles_normal', True, 84)),
    (surfaces.roof_tiles, ('roof_tiles', False, 84)),
    (surfaces.bronze, ('bronze', False, 85), ('bronze_packed', True, 82)),
    (textiles.weave_normal, ('weave_normal', True, 85)),
    (textiles.tapestry_stag, ('tapestry_stag', False, 84)),
    (textiles.tapestry_eagle, ('tapestry_eagle', False, 84)),
    (textiles.rug, ('rug', False, 84)),
    (textiles.book_page, ('book_page', False, 85)),
    (textiles.label, ('label', False, 85)),
    (textiles.white_marble, ('white_marble', False, 85)),
    (textiles.gilt, ('gilt', False, 85)),
    (textiles.jug, ('jug', False, 86)),
    (textiles.fossil, ('fossil', False, 85)),
    (landscapes.sky, ('sky', False, 88)),
    (landscapes.paint_castle, ('picture_castle', False, 87)),
    (landscapes.paint_river, ('picture_river', False, 86)),
    (landscapes.paint_moonlight, ('picture_moonlight', False, 86)),
    (landscapes.paint_forest, ('picture_forest', False, 86)),
    (landscapes.paint_winter, ('picture_winter', False, 86)),
    (portraits.paint_lady, ('picture_lady', False, 87)),
    (portraits.paint_nobleman, ('picture_nobleman', False, 87)),
    (portraits.paint_captain, ('picture_captain', False, 87)),
    (portraits.paint_still_life, ('picture_still_life', False, 87)),
    (portraits.paint_arms, ('picture_arms', False, 87)),
]


def all_pictures(only=None):
    """(name, pixels, is data, quality) of every picture, or of the recipes that make one of
    `only`."""
    for function, *results in RECIPES:
        if only is not None and not any(name in only for name, _, _ in results):
            continue
        made = function()
        for pixels, (name, data, quality) in zip(made if isinstance(made, tuple) else (made,),
                                                 results):
            yield name, pixels, data, quality
