<story>
<p><emotion name="joy" weight="0.35"/><gesture name="count_two"/>Two brothers once quarrelled about a horse.
<emotion name="anger" weight="0.4"/>It was the best horse of the castle, and each of them said: <gesture name="emphasize"/>it is <emphasis level="strong">mine</emphasis>.
They shouted so loudly that the <gesture name="point_up" weight="0.8"/>ravens left the tower.</p>

<p><emotion name="neutral"/>In the end they agreed on a race, and the horse was to run free between them.
<emotion name="surprise" weight="0.4"/>Down at the river they set off, <prosody rate="105%">faster,</prosody> <prosody rate="118%">and faster,</prosody> <prosody rate="130%">and faster.</prosody>
<break time="300ms"/><emotion name="joy" weight="0.7"/>And at the <gesture name="explain"/>very same bend, <break time="250ms"/>both of them fell into the very same ditch.<gesture name="laugh"/></p>

<p><emotion name="joy" weight="0.3"/><look at="horse"/>The horse came home <emphasis>alone</emphasis>.
<look at="visitor"/>It stopped in the courtyard, drank from the well, and let nobody near it <gesture name="heart" weight="0.7"/>but the children.</p>

<p><emotion name="sadness" weight="0.4"/>For seven days the brothers watched it, from two different windows.
<break time="300ms"/><prosody rate="88%">On the eighth day, they were <gesture name="sigh"/>ashamed.</prosody></p>

<p><emotion name="joy" weight="0.5"/>From then on they ruled together, with one table, one key, <point at="sword"/>and one sword.
<look at="horse"/>And they had the horse cast in bronze, <gesture name="large"/>rearing, without a saddle and without a bridle, so that nobody could ever own it.</p>

<p><look at="visitor"/>Go and look closely: <gesture name="point_near"/>one hoof is polished bright.
That is where the children still touch it, for luck.
<break time="400ms"/><emotion name="joy" weight="0.8"/>You may do it too; <look at="fireplace"/><prosody rate="92%">I shall look the <gesture name="shrug" weight="0.6"/>other way.</prosody></p>
</story>
