// SPDX-License-Identifier: Apache-2.0
// The holdings of Falconwell Castle, which exists in this exhibit alone: every record is written
// for it. A row is: title | maker | date | subjects | materials | colours; what a row leaves empty
// is its department's.
const text = (rows) => rows.trim().split('\n').map((row) => row.trim());

export const departments = [
  { name: 'Arms', subjects: 'armoury', materials: 'steel, leather', colours: 'steel, leather',
    rows: text(`
      Sword with a falcon's head pommel | Smiths of the lower town | about 1470 | war, falcon | steel, bronze | steel, bronze
      Hunting sword | Smiths of the lower town | 1541 | hunting | steel, horn | steel, bone
      Boar spear with a cross-bar | | about 1520 | hunting | iron, ash wood | iron, oak
      Halberd of the gate watch | Smiths of the lower town | 1588 | war, gate | iron, ash wood | iron, oak
      Crossbow with bone inlay | | about 1490 | hunting, war | walnut, bone, steel | walnut, bone, steel
      Windlass of a crossbow | | about 1490 | war | iron | iron
      Quiver for twelve bolts | | about 1500 | hunting | leather, boar skin | leather, umber
      Kettle hat | | about 1380 | war | iron | iron
      Mail shirt of eighteen thousand rings | | about 1410 | war | iron | iron, steel
      Gauntlet for the left hand | | about 1510 | war, tournament | steel, leather | steel, leather
      Gauntlet that fits a child | | about 1530 | childhood, tournament | steel, leather | steel, madder
      Jousting shield with the family's arms | Painter of shields | 1502 | tournament, arms, family | lime wood, leather | crimson, gold, black
      Rowel spurs | | about 1450 | horse | brass, leather | brass, leather
      Bit with long branches | | 1560 | horse | iron | iron
      Chamfron with a spike | | about 1515 | horse, tournament | steel | steel
      Saddle of a page | | about 1600 | horse, childhood | leather, beech | leather, oak, madder
      Dagger found in the moat | | about 1360 | war, well | iron, bone | iron, bone
      Powder horn with a map of the valley | | 1644 | hunting, map | horn, brass | bone, brass, ink
      Wheel-lock pistol | Gunsmith Hannes | 1618 | war | steel, walnut, ivory | steel, walnut, ivory
      Pike head bent at the ford | | 1632 | war, river | iron | iron`) },
  { name: 'Treasury', subjects: 'treasure', materials: 'silver', colours: 'silver, gold',
    rows: text(`
      Falconer's whistle | | about 1480 | falcon, hunting | silver | silver
      Bells for a falcon's legs | | about 1500 | falcon, bell | silver, leather | silver, leather
      Ring with a carnelian falcon | Unknown goldsmith | about 1350 | falcon, crown | gold, carnelian | gold, vermilion
      Brooch of Queen Adela | Unknown goldsmith | about 1342 | crown | gold, pearls, sapphire | gold, white, azurite
      Case for the crown | | 1345 | crown | leather, iron | leather, iron, gold
      Seed pearl that was sewn on again | | about 1340 | crown | pearl | white
      Salt cellar as a tower | Goldsmith Elias | 1612 | feast, gate | silver, gilding | silver, gold
      Double cup for a wedding | Goldsmith Elias | 1609 | feast, family | silver, gilding | silver, gold
      Beaker with the four seasons | Goldsmith Elias | 1615 | feast, harvest, winter | silver | silver
      Spoon of the first tooth | | 1688 | childhood, family | silver | silver
      Chain of the mayor | | 1750 | town, law | silver, gilding | silver, gold
      Seal of the castle | | 1397 | law, falcon | silver, brass | silver, brass
      Seal of the lower town | | 1421 | law, town, bell | brass | brass
      Purse with nine pennies of the ford | | about 1290 | river, market, law | leather, silver | leather, silver
      Hoard from under the stairs | | about 1420 | market, war | silver, copper | silver, copper
      Cross of rock crystal | | about 1330 | prayer | rock crystal, silver | snow, silver
      Rosary of amber | | about 1580 | prayer | amber, silk | amber, silk
      Locket with a curl of hair | | 1791 | family | gold, glass | gold, umber`) },
  { name: 'Table', subjects: 'household', materials: 'earthenware', colours: 'clay, honey',
    rows: text(`
      Jug with a bearded face | Potters of the lower town | about 1570 | feast | stoneware | umber, honey
      Jug that pours from three spouts | Potters of the lower town | 1633 | feast | earthenware | clay, green
      Bowl with a hare | Potters of the lower town | 1660 | hunting, feast | earthenware | honey, white, umber
      Bowl with a falcon | Potters of the lower town | 1661 | falcon, feast | earthenware | honey, white, umber
      Dish for carp | Potters of the lower town | 1702 | river, feast | faience | white, cobalt
      Dish with a view of the ford | Potters of the lower town | 1731 | river | faience | white, cobalt
      Tureen as a cabbage | | 1765 | feast | faience | green, white
      Plate of the harvest supper | | 1780 | harvest, feast | faience | white, ochre, green
      Cooking pot from the moat | Potters of the lower town | about 1450 | | earthenware | clay, black
      Tripod pan | Potters of the lower town | about 1500 | | earthenware | clay, green
      Roasting spit turned by a weight | Smiths of the lower town | 1595 | feast | iron, stone | iron, slate
      Waffle iron with the arms | Smiths of the lower town | 1670 | feast, arms | iron | iron
      Pewter plate with knife marks | | about 1640 | feast | pewter | pewter
      Pewter can of the coopers' guild | | 1688 | feast, town | pewter | pewter
      Glass with prunts | Glass hut in the forest | about 1480 | feast | forest glass | glass
      Glass with a long foot | Glass hut in the forest | about 1560 | feast | forest glass | glass
      Glass engraved with a wedding | Glass hut in the forest | 1712 | feast, family | glass | snow
      Wooden trencher of a kitchen boy | | about 1550 | childhood | lime wood | lime
      Spoon rack with eleven spoons | | 1718 | | pear wood | pear
      Butter mould with a star | | about 1800 | harvest, stars | lime wood | lime
      Gingerbread mould with a rider | | 1690 | horse, winter, feast | pear wood | pear
      Gingerbread mould with a cradle | | 1704 | childhood, winter, feast | pear wood | pear
      Well bucket with an iron hoop | | about 1700 | well | oak, iron | oak, iron
      Yoke for two buckets | | about 1740 | well | lime wood | lime`) },
  { name: 'Textiles', subjects: 'textile', materials: 'wool', colours: 'wool, madder, woad',
    rows: text(`
      Falcon hood with a plume | | about 1610 | falcon, hunting | leather, silk, feather | leather, crimson, feather
      Falconer's glove | | about 1590 | falcon, hunting | leather | leather
      Tapestry fragment with a unicorn | A workshop of four women | 1573 | hunting | wool, silk | green, weld, woad
      Tapestry fragment with the weaver's cat | A workshop of four women | 1571 | childhood | wool, silk | green, umber, weld
      Cushion with the four winds | A workshop of four women | 1580 | winter | wool, silk | woad, weld, madder
      Bed curtain with pomegranates | | about 1620 | family | wool | madder, weld
      Christening robe | | 1733 | childhood, prayer, family | silk, linen | white, silk
      Sampler by Barbora, aged nine | Barbora of Falconwell | 1794 | childhood | linen, silk | linen, madder, woad, green
      Wedding apron | | 1848 | family | linen | white, indigo
      Blue-printed cloth with bells | Dyers of the lower town | about 1860 | bell | linen | indigo, white
      Blue-printed cloth with the well | Dyers of the lower town | about 1865 | well | linen | indigo, white
      Altar cloth | | about 1510 | prayer | linen, gold thread | linen, gold
      Chasuble with a tree of saints | | about 1490 | prayer | velvet, gold thread | crimson, gold
      Banner of the ford | | 1632 | war, river | silk | sky, gold, crimson
      Banner of the bell founders | | 1704 | bell, town | silk | crimson, gold
      Gown of the last lady | | 1866 | family | silk | black, rose
      Shawl of the last lady | | about 1870 | family, winter | wool | crimson, ochre, green
      Night cap of a steward | | about 1720 | | linen | linen
      Stocking with a mended heel | | about 1690 | winter | wool | wool, indigo
      Horse blanket with the arms | | 1655 | horse, arms | wool | madder, weld`) },
  { name: 'Pictures', subjects: 'painting', materials: 'oil paint, canvas', colours: 'umber, ochre, sky',
    rows: text(`
      Portrait of a captain's widow | | about 1650 | family, war | | black, white, umber
      Portrait of a boy with a falcon | A painter of the valley | 1604 | falcon, childhood, family | | green, umber, rose
      Portrait of a girl with a bell | A painter of the valley | 1611 | bell, childhood, family | | crimson, rose, umber
      Portrait of the steward at his desk | | 1711 | law | | umber, white, black
      The castle in spring | A painter of the valley | about 1605 | river, harvest | | green, sky, ochre
      The castle in summer | A painter of the valley | about 1605 | harvest | | weld, sky, green
      The castle in autumn | A painter of the valley | about 1605 | hunting, harvest | | ochre, umber, sky
      The castle under snow | | 1778 | winter | | snow, slate, umber
      Skaters on the moat | | 1684 | winter, childhood | oil paint, oak panel | snow, slate, madder
      Night piece with a fire | | about 1690 | war, gate | | black, vermilion, ochre
      Still life with a hare | | 1667 | hunting, feast | | umber, feather, white
      Still life with a jug and lemons | | 1671 | feast | | weld, cobalt, black
      Still life with letters | | 1702 | law | | parchment, ink, vermilion
      Saint with an anvil | | about 1510 | prayer | tempera, lime panel | crimson, gold, azurite
      Saint with a bell | | about 1510 | prayer, bell | tempera, lime panel | green, gold, azurite
      Adoration in a snowy stable | | about 1520 | prayer, winter | tempera, lime panel | snow, azurite, gold
      The well, by moonlight | | 1826 | well, stars | | indigo, slate, white
      The ford with a hay cart | | 1819 | river, harvest, horse | | green, sky, ochre
      Watercolour of the great hall | Barbora of Falconwell | 1807 | family | watercolour, paper | white, ochre, sky
      Watercolour of the kitchen | Barbora of Falconwell | 1808 | household | watercolour, paper | white, umber, clay
      Silhouettes of five sisters | | 1798 | family, childhood | paper | black, white
      First photograph of the courtyard | | 1861 | well, town | paper, silver | umber, parchment
      Photograph of the open gate | | 1912 | gate, town | paper, silver | umber, parchment`) },
  { name: 'Books', subjects: 'writing', materials: 'paper, leather', colours: 'parchment, leather, ink',
    rows: text(`
      Charter of the market | | 1327 | market, law, town | parchment, wax | parchment, ink, wax
      Charter of the ford | | 1284 | river, law | parchment, wax | parchment, ink, wax
      Accounts of the well's digging | | 1352 | well, law | parchment | parchment, ink
      Book of hours with a falcon in the margin | | about 1460 | prayer, falcon | parchment | parchment, azurite, gold, vermilion
      Gradual of the chapel | | about 1480 | prayer, music | parchment, leather | parchment, ink, vermilion, leather
      Treatise on the care of falcons | Steward Ondrej | 1519 | falcon, hunting | |
      Cookery book with a burnt corner | | 1634 | feast | | parchment, umber
      Remedies for horses | Steward Ondrej | 1523 | horse | |
      Register of rents | | 1555 | law, harvest | |
      Register of the poor | | 1696 | law, winter | |
      Trial of the miller | | 1613 | law, river | paper | parchment, ink
      Songs for the lute | | about 1590 | music, feast | |
      Almanac with weather notes | | 1740 | stars, winter, harvest | | parchment, ink, vermilion
      Diary of a tutor | | 1771 | childhood, law | |
      Letters from the war | | 1813 | war, family | paper | parchment, ink
      Map of the parish, by a schoolboy | | 1850 | map, childhood | watercolour, paper | parchment, green, sky
      Plan of the fortifications | | 1661 | map, war, gate | paper | parchment, ink, madder
      Plan of the railway that was not built here | | 1872 | map, town | paper | white, vermilion, sky
      Inventory of 1788 | Steward Ignác | 1788 | law, household | |
      Deed by which the castle became the town's | The last lady | 1908 | law, town, gate, family | paper, wax | white, ink, vermilion`) },
  { name: 'Bells and music', subjects: 'music', materials: 'bronze', colours: 'bronze, verdigris',
    rows: text(`
      Model of a bell for the tower | Matouš the bell founder | 1461 | bell | bronze | bronze
      Clapper of the great bell | Matouš the bell founder | 1462 | bell | iron | iron
      Shard of the mould | Matouš the bell founder | 1462 | bell | clay | clay, black
      Board that sweeps a bell's shape | Matouš the bell founder | about 1460 | bell | oak, iron | oak, iron
      Bell of the chapel | Matouš the bell founder | 1466 | bell, prayer | bronze | bronze, verdigris
      Sheep bell | | about 1700 | bell, harvest | brass | brass
      Hand bell for dinner | | 1754 | bell, feast | silver | silver
      Cracked bell of the gate | | 1588 | bell, gate, war | bronze | bronze, verdigris
      Lute without strings | | about 1590 | feast | spruce, maple | lime, pear, walnut
      Hunting horn | | about 1610 | hunting | brass | brass, leather
      Drum of the town watch | | 1675 | town, war | oak, skin | madder, lime
      Hurdy-gurdy of a beggar | | about 1730 | market | walnut, gut | walnut, bone
      Clavichord of the tutor | | 1768 | childhood, family | walnut, bone | walnut, bone, black
      Musical box from a fair | | 1878 | market, childhood | walnut, brass | walnut, brass
      Cuckoo whistle | | about 1850 | childhood | clay | clay, honey`) },
  { name: 'House', subjects: 'furniture', materials: 'oak, iron', colours: 'oak, iron',
    rows: text(`
      Chest with seven bolts | Smiths of the lower town | 1580 | law, treasure | iron | iron
      Bride's chest with tulips | | 1746 | family | spruce | madder, green, weld
      Table at which nobody sat behind a pillar | | about 1460 | feast | oak | oak
      Bench from the gatehouse | | about 1500 | gate | oak | oak
      Chair of the judge | | 1547 | law | oak | oak
      High chair | | about 1690 | childhood | beech | lime
      Cradle with stars | | 1702 | childhood, stars, family | walnut | walnut, weld
      Wardrobe of two guilds | | 1688 | town | oak, walnut | oak, walnut
      Tiled stove with a lion's feet | Potters of the lower town | 1660 | winter | earthenware | green, clay
      Stove tile with a falcon | Potters of the lower town | about 1480 | falcon, winter | earthenware | green
      Stove tile with a knight | Potters of the lower town | about 1480 | war, tournament, winter | earthenware | green
      Stove tile with a musician | Potters of the lower town | about 1480 | music, winter | earthenware | honey
      Door lock as large as a book | Smiths of the lower town | about 1530 | gate, law | iron | iron
      Keys that the last lady gave away | | about 1650 | gate, family, town | iron | iron
      Door knocker with a falcon | | about 1600 | falcon, gate | bronze | bronze
      Lantern of the night watch | | about 1770 | gate, town | iron, horn | iron, bone
      Candlestick with a snuffer | | 1725 | | brass | brass
      Mirror that is blind | | about 1740 | family | glass, lime wood | snow, gold
      Clock with one hand | | 1603 | stars, town | iron, brass | iron, brass
      Chessboard with a missing king | | about 1680 | war, childhood | walnut, bone | walnut, bone
      Sledge with a swan's neck | | 1760 | winter, horse | lime wood | white, gold, madder
      Bird cage as a castle | | about 1830 | childhood | brass, beech | brass, lime`) },
  { name: 'Stones and finds', subjects: 'excavation', materials: 'stone', colours: 'sandstone, slate',
    rows: text(`
      Capital with oak leaves | | about 1290 | prayer | sandstone | sandstone
      Keystone with a falcon | Matej, mason | about 1350 | falcon, well | sandstone | sandstone
      Rim stone worn by ropes | Matej, mason | about 1350 | well | sandstone | sandstone, slate
      Mason's mark in a sill | Matej, mason | about 1348 | well | sandstone | sandstone
      Mason's level and plumb | Matej, mason | about 1350 | well | pear wood, lead | pear, lead
      Loom weight | | about 850 | textile, river | clay | clay
      Urn from the ford | | about 900 BC | river | clay | umber, black
      Bronze sickle | | about 1100 BC | harvest, river | bronze | verdigris, bronze
      Whetstone with a hole | | about 300 | river, harvest | stone | slate
      Coin of an emperor | | about 270 | market, river | bronze | verdigris
      Horseshoe from the moat | | about 1300 | horse | iron | iron, ochre
      Arrowheads from the moat | | about 1310 | war, hunting | iron | iron, ochre
      Shoe of a child | | about 1420 | childhood, well | leather | leather
      Dice made of bone | | about 1500 | feast | bone | bone
      Comb with a heart | | about 1520 | family | bone | bone
      Dolls' jug | Potters of the lower town | about 1560 | childhood, feast | earthenware | honey
      Wish tablets from the well | | about 1650 | well, prayer | lead | lead
      Coins that were thrown into the well | | about 1900 | well, market | copper, nickel | copper, pewter
      Stone with a fern | | found 1349 | well | slate | slate, black
      Tooth of a cave bear | | found 1861 | hunting | bone | bone, umber
      Head of a king from the portal | | about 1360 | crown | sandstone | sandstone
      Marble hand | | about 1780 | crown | marble | marble`) },
  { name: 'Learning', subjects: 'science', materials: 'brass, glass', colours: 'brass, glass',
    rows: text(`
      Sundial for a pocket | | 1628 | stars | brass, ivory | brass, ivory
      Astrolabe | | about 1540 | stars | brass | brass
      Quadrant of a surveyor | | 1659 | map, stars | brass | brass
      Telescope of six tubes | | 1718 | stars | cardboard, brass | leather, brass
      Celestial globe | | 1745 | stars, map | paper, oak | azurite, parchment, oak
      Terrestrial globe without Australia | | 1745 | map | paper, oak | parchment, green, oak
      Burning glass | | about 1760 | harvest | glass, walnut | snow, walnut
      Weights of the market, nested | | 1651 | market, law | brass | brass
      Scales for gold | | 1694 | market, treasure | brass, pear wood | brass, pear
      Ell of the cloth market | | 1580 | market, textile | iron | iron
      Cabinet of minerals | Steward Ignác | 1790 | treasure | walnut, minerals | walnut, verdigris, amber
      Box of butterflies | Barbora of Falconwell | 1811 | childhood | paper, glass | azurite, ochre, white
      Stuffed falcon | | about 1880 | falcon, hunting | feather, wire | feather, white, ochre
      Egg of a falcon | | 1874 | falcon | shell | rose, umber
      Barometer that says change | | 1829 | winter | walnut, mercury | walnut, silver
      Magic lantern | | about 1875 | childhood, winter | tin, glass | black, brass
      Slides of a journey to Alexandria | | about 1878 | river, map | glass | cobalt, ochre, black`) },
];

// Records that stand in the exhibit: the number of the label, and the object's id.
export const shown = text(`
  FW 1 | crown | Crown of Queen Adela | Unknown goldsmith | about 1340 | treasure, crown | gold, ruby, pearls | gold, crimson, white
  FW 2 | goblet | Golden goblet | | about 1420 | treasure, feast | silver, gilding | gold, silver
  FW 3 | helmet | Great helm | | about 1330 | armoury, war | iron | iron, steel
  FW 4 | ammonite | Ammonite from the well | | found about 1350 | excavation, well | stone | slate, sandstone
  FW 5 | sword | Sword of the two brothers | Smiths of the lower town | 1388 | armoury, war, family | steel, brass, leather | steel, brass, leather
  FW 6 | book | Chronicle of Falconwell | Eleven scribes | 1352–1497 | writing, law, well | parchment, leather | parchment, ink, leather
  FW 7 | jug | Painted jug | Potters of the lower town | about 1600 | household, feast, excavation | earthenware | clay, white, cobalt
  FW 8 | horse | Bronze horse | Matouš the bell founder | 1462 | horse, bell, music | bronze | bronze, verdigris
  FW 9 | bust | Marble king | | 18th century | crown | marble | marble
  FW 10 | armour | Suit of armour | | about 1510 | armoury, war, tournament | steel, leather | steel, leather
  FW 12 | paintings | The castle in winter | | about 1650 | painting, winter | oil paint, canvas | snow, slate, umber
  FW 21 | tapestries | Tapestries of the great hall | A workshop of four women | 1571 | textile, hunting | wool, silk | green, woad, madder, weld
  FW 22 | fireplace | Fireplace with recut arms | | 1448 | furniture, winter, arms | sandstone | sandstone, black
  FW 23 | well | The well | Matej, mason | about 1350 | well | sandstone | sandstone, slate
  FW 25 | alexandrite | Alexandrite | | 1842 | treasure, science | chrysoberyl | verdigris, crimson
  FW 26 | diamond | Diamond | | 1790 | treasure, science | diamond | snow
  FW 27 | ruby | Ruby | | 1790 | treasure, science | corundum | crimson
  FW 28 | prism | Prism | | 1790 | science, stars | glass | snow, azurite, vermilion, weld
  FW 11 | valley | The valley in the year of the well | A painter of the valley | about 1600 | painting, well, river, map | oil paint, canvas | green, sky, ochre
  FW 29 | second-falcon | The second falcon | A painter of the valley | about 1620 | painting, falcon, stars | oil paint, oak panel | azurite, umber, white
  FW 24 | falcon | The wrapped falcon | | about 100 BC | falcon, prayer, excavation | linen, cartonnage | linen, ochre, azurite`);
