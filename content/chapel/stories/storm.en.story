<story>
<p><emotion name="joy" weight="0.35"/>Stand still for a moment, and <gesture name="listen"/>listen. <break time="500ms"/>That is the wind, the only <emphasis>choir</emphasis> that this chapel has left.</p>

<p><emotion name="sadness" weight="0.4"/>More than two hundred years ago, on a night in November, it came over the hills <gesture name="large"/>and tore at the roof.
Old Ondrej, the sexton, ran up from the village, <look at="tomb"/>for in here a lord of the castle lay in his tomb, <look at="visitor"/><gesture name="point_up"/>and above him hung a vault full of cracks.</p>

<p><emotion name="fear" weight="0.6"/>He had hardly lit his lantern when the <gesture name="count_one"/>first rib fell. <break time="350ms"/>Then the <gesture name="count_two"/>second.
<prosody volume="soft" rate="90%">He crept under the arch of the apse, <gesture name="hush" weight="0.7"/>and counted the stones as they came down.</prosody></p>

<p><emotion name="surprise" weight="0.5"/>And there beside him in the dark sat a <emphasis>falcon</emphasis>, wet and <gesture name="small"/>trembling.
It would not <gesture name="shake_head" weight="0.6"/>move from the wall below the window.</p>

<p><emotion name="joy" weight="0.7"/>In the morning there was no roof. <break time="300ms"/>But there was <gesture name="open_arms"/>light, more light than anybody had ever seen in here.
<look at="capital"/>And that capital lay with its face in the plaster, with not one leaf broken.<look at="visitor"/></p>

<p><emotion name="neutral"/>Ondrej told everybody that the falcon had been <gesture name="explain" weight="0.7"/>guarding something in the wall. They <gesture name="shrug" weight="0.6"/>laughed.
<prosody rate="90%">Seventy years went by until somebody looked, <emotion name="surprise" weight="0.4"/>and found a <gesture name="wonder"/><emphasis>crown</emphasis>.</prosody></p>

<p><emotion name="joy" weight="0.45"/>So if one day a bird sits on your wall, and <gesture name="emphasize" weight="0.7"/>will not leave, <break time="300ms"/><prosody rate="88%">do not chase it away.</prosody></p>
</story>
